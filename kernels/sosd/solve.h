#ifndef WEFT_KERNELS_SOSD_SOLVE_H
#define WEFT_KERNELS_SOSD_SOLVE_H

#include "kernels/descent/rows.h"
#include "kernels/energies/spring.h"

WEFT_KERNELS_BEGIN

/// One vertex of a stencil: D = m/h^2 I + H, and the force that is left, f = -dE/dx.
typedef struct {
    real4 x;
    integer vertex;
    sym3 stiffness;
    real3 force;
} stencil_corner;

WEFT_INLINE stencil_corner load_corner(WEFT_GLOBAL const float4* positions,
                                       WEFT_GLOBAL const float4* targets,
                                       WEFT_GLOBAL const int* vertices,
                                       WEFT_GLOBAL const float* sums, item i, int items,
                                       float inverse_h2) {
    stencil_corner c;
    c.vertex = load_index(vertices, i);
    c.x = gather4(positions, c.vertex);
    const slope s = load_slope(sums, i, items);
    const real inertia = inverse_h2 / (c.x.w > splat(0.0f) ? c.x.w : splat(1.0f));
    const real3 away = subtract(xyz(gather4(targets, c.vertex)), xyz(c.x));
    c.stiffness = add_diagonal(s.hessian, inertia);
    c.force = subtract(scale(away, inertia), s.gradient);
    return c;
}

/// Moves the two vertices of each stencil, a spring, to the minimum of their common quadratic model
/// of E while all others stand still. With K the spring's block:
///   [ D0  -K ] [dx0]   [f0]
///   [ -K  D1 ] [dx1] = [f1]     by elimination of dx0; D0 and D1 contain K, so it is definite
/// positions   [vertices] xyz [m], w = 1/mass [1/kg]; read and written
/// targets     [vertices] xyz: x~ [m]
/// vertices    [items] two items per stencil; a vertex that is alone is both
/// corners     [2 * stencils] column-major: the first and the second item; neighbours for
///             neighbouring stencils
/// material    [2 * stencils] column-major: rest length [m], stiffness [N/m] of the spring; 0 for a
///             vertex that is alone
/// sums        [9 * items] g and H of all elements; see descent/rows.h
/// inverse_h2  1 / h^2 [1/s^2], h the substep
/// Stencils of one call share no element.
WEFT_KERNEL(solve_stencils, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const float4* targets,
            WEFT_GLOBAL const int* vertices, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* material, WEFT_GLOBAL const float* sums, int stencil_count,
            int item_count, float inverse_h2) {
    const item first = {corners[i.first], i.count};
    const item second = {corners[i.first + stencil_count], i.count};
    const stencil_corner a =
        load_corner(positions, targets, vertices, sums, first, item_count, inverse_h2);
    const stencil_corner b =
        load_corner(positions, targets, vertices, sums, second, item_count, inverse_h2);

    // Held vertices stand still, and what they do not do couples to nothing.
    const real free_a = a.x.w > splat(0.0f) ? splat(1.0f) : splat(0.0f);
    const real free_b = b.x.w > splat(0.0f) ? splat(1.0f) : splat(0.0f);
    const sym3 k = scale_sym(spring_hessian(xyz(a.x), xyz(b.x), load(material, i),
                                            load(material, column(i, stencil_count, 1))),
                             free_a * free_b);

    // The columns of D0^-1 K, and the Schur complement D1 - K D0^-1 K.
    const real3 u = solve_sym(a.stiffness, make3(k.xx, k.xy, k.xz));
    const real3 v = solve_sym(a.stiffness, make3(k.xy, k.yy, k.yz));
    const real3 w = solve_sym(a.stiffness, make3(k.xz, k.yz, k.zz));
    const real3 ku = multiply_sym(k, u);
    const real3 kv = multiply_sym(k, v);
    const real3 kw = multiply_sym(k, w);
    const sym3 left = add_sym(b.stiffness, make_sym(-ku.x, -ku.y, -ku.z, -kv.y, -kv.z, -kw.z));
    const real3 alone = solve_sym(a.stiffness, a.force);
    const real3 step_b = solve_sym(left, add(b.force, multiply_sym(k, alone)));
    const real3 carried = add(add(scale(u, step_b.x), scale(v, step_b.y)), scale(w, step_b.z));
    const real3 step_a = add(alone, carried);

    scatter4(positions, a.vertex, with_w(add_scaled(xyz(a.x), step_a, free_a), a.x.w));
    scatter4(positions, b.vertex, with_w(add_scaled(xyz(b.x), step_b, free_b), b.x.w));
}

WEFT_KERNELS_END

#endif
