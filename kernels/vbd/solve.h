#ifndef WEFT_KERNELS_VBD_SOLVE_H
#define WEFT_KERNELS_VBD_SOLVE_H

#include "kernels/descent/rows.h"

WEFT_KERNELS_BEGIN

/// Moves each vertex to the minimum of its quadratic model of E while all others stand still:
/// (m/h^2 I + H) dx = m/h^2 (x~ - x) - g. Chen et al. 2024 (VBD), equations 9 to 12.
/// positions   [vertices] xyz [m], w = 1/mass [1/kg]; read and written
/// targets     [vertices] xyz: x~ [m]
/// vertices    [items] the vertex of each item
/// sums        [9 * items] g and H of all elements; see descent/rows.h
/// inverse_h2  1 / h^2 [1/s^2], h the substep
/// Vertices of one call share no element.
WEFT_KERNEL(solve_vertices, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const float4* targets,
            WEFT_GLOBAL const int* vertices, WEFT_GLOBAL const float* sums, int item_count,
            float inverse_h2) {
    const integer vertex = load_index(vertices, i);
    const real4 x = gather4(positions, vertex);
    const real3 target = xyz(gather4(targets, vertex));
    const slope s = load_slope(sums, i, item_count);

    // Held vertices have no mass to divide by; whatever comes out, they do not take it.
    const real inertia = inverse_h2 / (x.w > splat(0.0f) ? x.w : splat(1.0f));
    const real free = x.w > splat(0.0f) ? splat(1.0f) : splat(0.0f);
    const real3 force = subtract(scale(subtract(target, xyz(x)), inertia), s.gradient);
    const real3 step = solve_sym(add_diagonal(s.hessian, inertia), force);
    scatter4(positions, vertex, with_w(add_scaled(xyz(x), step, free), x.w));
}

WEFT_KERNELS_END

#endif
