#ifndef WEFT_KERNELS_OBSTACLES_INSIDE_H
#define WEFT_KERNELS_OBSTACLES_INSIDE_H

#include "kernels/lanes.h"
#include "kernels/obstacles/seen.h"

WEFT_KERNELS_BEGIN

/// Where contact has taken back what obstacles had pushed: how far each vertex is inside of them,
/// or has come through them in the substep, by the way that counts for pushes.
/// positions   [vertices] xyz at the substep's end [m], w = 1/mass [1/kg]
/// previous    [vertices] xyz at its start [m]
/// obstacles   [substeps * obstacle_count * WEFT_OBSTACLE_ROWS], see contact.h
/// cut         [vertices] not 0: contact has taken it back
/// depths      [vertices] written: the most in the frame so far [m]
/// insides     [vertices] written: of which obstacle
WEFT_KERNEL(find_inside, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float4* previous,
            WEFT_GLOBAL const float4* obstacles, WEFT_GLOBAL const int* cut,
            WEFT_GLOBAL float* depths, WEFT_GLOBAL int* insides, int obstacle_count, int substep) {
    const whole none = splat_whole(0);
    const whole was_cut = load_whole(cut, i);
    if (substep != 0 && largest_whole(was_cut) == 0) return;
    real deepest = substep == 0 ? splat(0.0f) : load(depths, i);
    whole inside = substep == 0 ? none : load_whole(insides, i);
    const real4 x = load4(positions, i);
    const real3 start = xyz(load4(previous, i));
    const mask counts = both(was_cut > none, x.w > splat(0.0f));
    for (int k = 0; k < obstacle_count; ++k) {
        WEFT_GLOBAL const float4* o =
            obstacles + WEFT_OBSTACLE_ROWS * (substep * obstacle_count + k);
        const real depth = -seen_from(o, start, xyz(x)).distance;
        const mask is_deeper = both(counts, depth > deepest);
        deepest = is_deeper ? depth : deepest;
        inside = is_deeper ? splat_whole(k) : inside;
    }
    store(depths, i, deepest);
    store_whole(insides, i, inside);
}

WEFT_KERNELS_END

#endif
