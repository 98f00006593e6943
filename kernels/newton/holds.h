#ifndef WEFT_KERNELS_NEWTON_HOLDS_H
#define WEFT_KERNELS_NEWTON_HOLDS_H

// What holds vertices while a system is solved: an active set, as projected Newton methods have it
// (Bertsekas 1982). A system that knows nothing of the ground leads a block into it by all of its
// inertia, and its lowest vertices are pushed out behind that, one by one: the block stored several
// times the energy of its fall. And where planes between surfaces take single vertices back, all
// others go on. With these held, the system finds how the others follow.

#include "kernels/descent/rows.h"
#include "kernels/jpgd/control.h"
#include "kernels/obstacles/nearest.h"

WEFT_KERNELS_BEGIN

/// The part of a vector that a hold leaves.
/// hold  xyz: n, of length 1; w: 0 where nothing holds, 1 along n, 2 in all directions
WEFT_INLINE real3 held_back(real3 v, real4 hold) {
    const real one = splat(1.0f);
    const real zero = splat(0.0f);
    const real stays = hold.w > one ? zero : one;
    const real3 along = add_scaled(v, xyz(hold), -dot3(v, xyz(hold)) * hold.w);
    return scale(along, stays);
}

/// Which vertices are held, at the positions at hand.
/// positions  [vertices] xyz [m], w = 1/mass [1/kg]
/// previous   [vertices] xyz at the substep's start [m]
/// starts     [vertices] xyz: x~ before obstacles have pushed [m]
/// targets    [vertices] w: the grip, above 0 where they have (obstacles/grip.h)
/// sums       [9 * vertices] gradients of all elements and contacts (descent/rows.h)
/// solid      [vertices] 1: of a solid; else 0
/// cut        [vertices] not 0: contacts have taken the vertex back (contact/truncate.h); not read
///            unless has_contacts. Solids are held there, and cloth where a step has just been taken
///            back: what slides along planes goes on
/// control    see newton/control.h
/// obstacles  [substeps * obstacle_count * WEFT_OBSTACLE_ROWS], see obstacles/contact.h: a vertex of
///            a solid on one of them that is pressed into it is held along its normal
/// holds      [vertices] written, as in held_back
/// inverse_h2 1 / h^2 [1/s^2], h the substep
WEFT_KERNEL(find_holds, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float4* previous,
            WEFT_GLOBAL const float4* starts, WEFT_GLOBAL const float4* targets,
            WEFT_GLOBAL const float* sums, WEFT_GLOBAL const float* solid,
            WEFT_GLOBAL const int* cut, WEFT_GLOBAL const float* control,
            WEFT_GLOBAL const float4* obstacles, WEFT_GLOBAL float4* holds, int vertex_count,
            int has_contacts, int obstacle_count, float inverse_h2, int substep) {
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const real4 x = load4(positions, i);
    const real is_solid = load(solid, i);
    real4 hold = {zero, zero, zero, zero};
    if (obstacle_count > 0) {
        const mask was_pushed = both(load4(targets, i).w * is_solid > zero, x.w > zero);
        if (any_item(was_pushed)) {
            const surface_contact c =
                nearest_surface(obstacles + WEFT_OBSTACLE_ROWS * (substep * obstacle_count),
                                obstacle_count, xyz(load4(previous, i)), xyz(x));
            const real inertia = splat(inverse_h2) / (was_pushed ? x.w : one);
            const real3 force = subtract(scale(subtract(xyz(load4(starts, i)), xyz(x)), inertia),
                                         load_gradient(sums, i, vertex_count));
            const real a_few_roundings = splat(2e-6f) * length3(xyz(x));
            const mask is_there = both(was_pushed, c.gap < a_few_roundings);
            const mask is_pressed = both(is_there, dot3(force, c.normal) < zero);
            const real held = c.beside < a_few_roundings ? splat(2.0f) : one;
            hold.x = is_pressed ? c.normal.x : zero;
            hold.y = is_pressed ? c.normal.y : zero;
            hold.z = is_pressed ? c.normal.z : zero;
            hold.w = is_pressed ? held : zero;
        }
    }
    if (has_contacts) {
        const real asks = control[WEFT_REVERT] > 0.0f ? one : is_solid;
        const real is_cut = load_whole(cut, i) > splat_whole(0) ? asks : zero;
        hold.w = is_cut > zero ? splat(2.0f) : hold.w;
    }
    store4(holds, i, hold);
}

WEFT_KERNELS_END

#endif
