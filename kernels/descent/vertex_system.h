#ifndef WEFT_KERNELS_DESCENT_VERTEX_SYSTEM_H
#define WEFT_KERNELS_DESCENT_VERTEX_SYSTEM_H

#include "kernels/descent/rows.h"

WEFT_KERNELS_BEGIN

/// The quadratic model of E of one vertex while all others stand still: stiffness dx = force moves
/// it to the minimum.
typedef struct {
    integer vertex;
    real4 x;         ///< xyz [m], w = 1/mass [1/kg]
    real free;       ///< 0: held, to be left where it is; else 1
    sym3 stiffness;  ///< m/h^2 I + H
    real3 force;     ///< m/h^2 (x~ - x) - g = -dE/dx
} vertex_system;

/// positions   [vertices] xyz [m], w = 1/mass [1/kg]
/// targets     [vertices] xyz: x~ [m]
/// vertices    [items] the vertex of each item
/// sums        [9 * items] g and H of all elements; see descent/rows.h
/// inverse_h2  1 / h^2 [1/s^2], h the substep
WEFT_INLINE vertex_system load_system(WEFT_GLOBAL const float4* positions,
                                      WEFT_GLOBAL const float4* targets,
                                      WEFT_GLOBAL const int* vertices,
                                      WEFT_GLOBAL const float* sums, item i, int item_count,
                                      float inverse_h2) {
    vertex_system v;
    v.vertex = load_index(vertices, i);
    v.x = gather4(positions, v.vertex);
    const real3 target = xyz(gather4(targets, v.vertex));
    const derivatives s = load_derivatives(sums, i, item_count);
    // Held vertices have no mass to divide by; whatever comes out, they do not take it.
    const real inertia = inverse_h2 / (v.x.w > splat(0.0f) ? v.x.w : splat(1.0f));
    v.free = v.x.w > splat(0.0f) ? splat(1.0f) : splat(0.0f);
    v.stiffness = add_diagonal(s.hessian, inertia);
    v.force = subtract(scale(subtract(target, xyz(v.x)), inertia), s.gradient);
    return v;
}

WEFT_INLINE void move_vertex(WEFT_GLOBAL float4* positions, vertex_system v, real3 step) {
    scatter4(positions, v.vertex, with_w(add_scaled(xyz(v.x), step, v.free), v.x.w));
}

WEFT_KERNELS_END

#endif
