#ifndef WEFT_KERNELS_MOTION_H
#define WEFT_KERNELS_MOTION_H

// The beginning and the end of a substep, and pins that are carried along.

#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// The velocity with which a vertex would fall freely; a held vertex (1/mass = 0) has none.
WEFT_INLINE real3 falling_velocity(real4 velocity, real inverse_mass, float4 gravity, float h) {
    const real3 v =
        make3(velocity.x + h * gravity.x, velocity.y + h * gravity.y, velocity.z + h * gravity.z);
    const real free = inverse_mass > splat(0.0f) ? splat(1.0f) : splat(0.0f);
    return scale(v, free);
}

/// x~ = x + h (v + h g): where a vertex gets to if nothing holds it. Parameters as in `predict`.
WEFT_INLINE real3 falling_place(real3 previous, real4 velocity, real inverse_mass, float4 gravity,
                                float h) {
    return add_scaled(previous, falling_velocity(velocity, inverse_mass, gravity, h), splat(h));
}

/// Moves every vertex as if nothing held it.
/// positions   [vertices] xyz [m], w = 1/mass [1/kg]; from x to x~
/// previous    [vertices] written: x
/// velocities  [vertices] xyz [m/s]
/// gravity     [substeps] xyz [m/s^2]
/// h           the substep [s]
/// substep     of the frame
WEFT_KERNEL(predict, WEFT_GLOBAL float4* positions, WEFT_GLOBAL float4* previous,
            WEFT_GLOBAL const float4* velocities, WEFT_GLOBAL const float4* gravity, float h,
            int substep) {
    const real4 x = load4(positions, i);
    const real3 target = falling_place(xyz(x), load4(velocities, i), x.w, gravity[substep], h);
    store4(previous, i, x);
    store4(positions, i, with_w(target, x.w));
}

/// What the solver did, as a velocity. v = v~ + (x - x~) / h, with v~ and x~ made again by the same
/// arithmetic as in `predict`: so free fall is exact, where (x - previous) / h would round.
WEFT_INLINE real3 new_velocity(real4 x, real4 previous, real4 velocity, float4 gravity, float h,
                               float inverse_h) {
    const real3 v = falling_velocity(velocity, x.w, gravity, h);
    const real3 predicted = add_scaled(xyz(previous), v, splat(h));
    const real3 moved = add_scaled(v, subtract(xyz(x), predicted), splat(inverse_h));
    const real free = x.w > splat(0.0f) ? splat(1.0f) : splat(0.0f);
    return scale(moved, free);
}

/// Ends a substep: velocities from positions. Parameters as in `predict`; inverse_h = 1 / h.
WEFT_KERNEL(update_velocities, WEFT_GLOBAL const float4* positions,
            WEFT_GLOBAL const float4* previous, WEFT_GLOBAL float4* velocities,
            WEFT_GLOBAL const float4* gravity, float h, float inverse_h, int substep) {
    const real4 v = load4(velocities, i);
    const real3 moved =
        new_velocity(load4(positions, i), load4(previous, i), v, gravity[substep], h, inverse_h);
    store4(velocities, i, with_w(moved, v.w));
}

/// The same with damping: velocities' w is the part of the velocity that a substep leaves,
/// 1 / (1 + h damping).
WEFT_KERNEL(update_damped_velocities, WEFT_GLOBAL const float4* positions,
            WEFT_GLOBAL const float4* previous, WEFT_GLOBAL float4* velocities,
            WEFT_GLOBAL const float4* gravity, float h, float inverse_h, int substep) {
    const real4 v = load4(velocities, i);
    const real3 moved =
        new_velocity(load4(positions, i), load4(previous, i), v, gravity[substep], h, inverse_h);
    store4(velocities, i, with_w(scale(moved, v.w), v.w));
}

/// Puts pinned vertices where their motion has them at the end of the substep.
/// positions  [vertices] xyz [m], w = 0; written
/// vertices   [pins] which
/// rest       [pins] xyz at time 0 [m]
/// motions    [substeps * 3 * group_count] rows (r, t) of each group's map: x = r . rest + t
WEFT_KERNEL(move_pins, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const int* vertices,
            WEFT_GLOBAL const float4* rest, WEFT_GLOBAL const float4* motions, int group_count,
            int group, int substep) {
    const integer vertex = load_index(vertices, i);
    const real4 p = load4(rest, i);
    WEFT_GLOBAL const float4* rows = motions + 3 * (substep * group_count + group);
    const real x = p.x * rows[0].x + p.y * rows[0].y + p.z * rows[0].z + splat(rows[0].w);
    const real y = p.x * rows[1].x + p.y * rows[1].y + p.z * rows[1].z + splat(rows[1].w);
    const real z = p.x * rows[2].x + p.y * rows[2].y + p.z * rows[2].z + splat(rows[2].w);
    scatter4(positions, vertex, with_w(make3(x, y, z), splat(0.0f)));
}

/// Puts vertices on the straight way that they go in this frame, where the substep ends; at the
/// frame's end exactly to its end.
/// positions  [vertices] xyz [m], w = 0; written
/// vertices   [count] which
/// ends       [2 * count] xyz [m] of each at the frame's start, then of each at its end
/// step       1 / substeps
WEFT_KERNEL(move_between, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const int* vertices,
            WEFT_GLOBAL const float4* ends, int count, int substeps, float step, int substep) {
    const integer vertex = load_index(vertices, i);
    const real4 start = load4(ends, i);
    const real4 end = load4(ends + count, i);
    const real left = splat((float)(substeps - 1 - substep) * step);
    const real3 way = subtract(xyz(start), xyz(end));
    scatter4(positions, vertex, with_w(add_scaled(xyz(end), way, left), splat(0.0f)));
}

WEFT_KERNELS_END

#endif
