#ifndef WEFT_KERNELS_DESCENT_SUBSTEP_H
#define WEFT_KERNELS_DESCENT_SUBSTEP_H

// The beginning and the end of a substep of the methods that descend
// E(x) = |x - x~|^2_M / (2 h^2) + elements, with x~ as in motion.h.

#include "kernels/motion.h"
#include "kernels/obstacles/grip.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// Computes x~ and where to start from: x~ less that part of the fall which was held up in the
/// substep before. Chen et al. 2024 (VBD, section 3.7) take the last acceleration's part along
/// gravity, between 0 and gravity itself; here it comes from x - x~ instead of a difference of
/// velocities, so that damping is no acceleration, and what falls freely starts at x~ exactly.
/// positions   [vertices] xyz [m], w = 1/mass [1/kg]; from x_t to the start
/// previous    [vertices] written: x_t
/// targets     [vertices] from x - x~ of the last substep to x~; w = 0
/// velocities  [vertices] xyz [m/s]
/// gravity     [substeps] xyz [m/s^2]
/// h, h2       the substep [s], and its square
/// substep     of the frame
WEFT_KERNEL(begin_descent, WEFT_GLOBAL float4* positions, WEFT_GLOBAL float4* previous,
            WEFT_GLOBAL float4* targets, WEFT_GLOBAL const float4* velocities,
            WEFT_GLOBAL const float4* gravity, float h, float h2, int substep) {
    const real4 x = load4(positions, i);
    const float4 g = gravity[substep];
    const real3 target = falling_place(xyz(x), load4(velocities, i), x.w, g, h);

    const real3 held = xyz(load4(targets, i));
    const float size = g.x * g.x + g.y * g.y + g.z * g.z;
    const float inverse = size > 0.0f ? 1.0f / size : 0.0f;
    const real fall = (held.x * g.x + held.y * g.y + held.z * g.z) * inverse;
    // What is small against the fall is rounding, or the last trace of what is long gone: kept, it
    // would hold up a stiff body for ever, which is slow to move as a whole.
    const real held_up = smaller(larger(fall, splat(-h2)), splat(0.0f));
    const real share = held_up < splat(-0.125f * h2) ? held_up : splat(0.0f);
    const real3 start =
        make3(target.x + share * g.x, target.y + share * g.y, target.z + share * g.z);

    store4(previous, i, x);
    store4(targets, i, with_w(target, splat(0.0f)));
    store4(positions, i, with_w(start, x.w));
}

/// copy [vertices] = positions
WEFT_KERNEL(copy_positions, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL float4* copy) {
    store4(copy, i, load4(positions, i));
}

/// Nothing presses yet.
/// pressing  [vertices] written (obstacles/contact.h)
WEFT_KERNEL(start_pressing, WEFT_GLOBAL float4* pressing) {
    const real zero = splat(0.0f);
    store4(pressing, i, with_w(make3(zero, zero, zero), zero));
}

/// x~ of free vertices that are there by now, of bodies that are never turned.
/// positions  [vertices] xyz: x~ [m]
/// targets    [vertices] written: xyz: x~; w: no grip
WEFT_KERNEL(start_targets, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL float4* targets) {
    store4(targets, i, with_w(xyz(load4(positions, i)), splat(WEFT_NO_GRIP)));
}

/// Keeps what begin_descent wants to know in the next substep.
/// positions  [vertices] xyz [m]
/// targets    [vertices] from x~ to x - x~
WEFT_KERNEL(keep_deviation, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL float4* targets) {
    const real3 x = xyz(load4(positions, i));
    const real4 target = load4(targets, i);
    store4(targets, i, with_w(subtract(x, xyz(target)), target.w));
}

WEFT_KERNELS_END

#endif
