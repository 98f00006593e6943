#ifndef WEFT_KERNELS_XPBD_MEMBRANES_H
#define WEFT_KERNELS_XPBD_MEMBRANES_H

#include "kernels/energies/membrane.h"
#include "kernels/platform.h"
#include "kernels/triangles.h"
#include "kernels/vector.h"
#include "kernels/xpbd/pair.h"

WEFT_KERNELS_BEGIN

/// Projects triangles of stable Neo-Hookean membrane (kernels/energies/membrane.h) as two XPBD
/// constraints at once, as tetrahedra.h does solids: its energy is mu/2 S^2 + lambda/2 (J - 1)^2
/// with S^2 = |F|^2 - 2 J, so S has compliance 1/mu and J - 1 has 1/lambda.
///
/// positions    [vertices] xyz [m], w = 1/mass [1/kg]; read and written
/// corners      [3 * count] column-major
/// shape        [4 * count] column-major: b_1, b_2 [1/m], in the plane at rest
/// material     [2 * count] column-major: mu, lambda, times the rest area [J]
/// of_area, of_shape  [count] multipliers of J - 1 and of S; taken as 0 where `fresh`
/// inverse_h2   1 / h^2 [1/s^2], h the substep
/// fresh        1 in the first iteration of a substep, else 0
/// Triangles of one call share no vertex.
WEFT_KERNEL(project_membranes, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* shape, WEFT_GLOBAL const float* material,
            WEFT_GLOBAL float* of_area, WEFT_GLOBAL float* of_shape, int count, float inverse_h2,
            int fresh) {
    const integer k0 = load_index(corners, i);
    const integer k1 = load_index(corners, column(i, count, 1));
    const integer k2 = load_index(corners, column(i, count, 2));
    const triangle_shape t = load_triangle_shape(shape, i, count);
    const real2 b1 = t.b[1];
    const real2 b2 = t.b[2];
    const real mu = load(material, i);
    const real lambda = load(material, column(i, count, 1));
    const real area_multiplier = fresh ? splat(0.0f) : load(of_area, i);
    const real shape_multiplier = fresh ? splat(0.0f) : load(of_shape, i);
    const real4 x0 = gather4(positions, k0);
    const real4 x1 = gather4(positions, k1);
    const real4 x2 = gather4(positions, k2);

    const membrane m = make_membrane(xyz(x0), xyz(x1), xyz(x2), b1, b2, mu, lambda);
    const membrane_strain strain = strain_of_membrane(m);
    const real shape_strain = square_root(larger(strain.shape, splat(0.0f)));
    const real inverse = inverse_strain(shape_strain);
    // Gradients of both constraints at the corners 1 and 2; corner 0 balances them.
    const real3 a1 = membrane_growth(m, b1);
    const real3 a2 = membrane_growth(m, b2);
    const real3 a0 = add(a1, a2);
    const real3 s1 = scale(subtract(membrane_map(m, b1), a1), inverse);
    const real3 s2 = scale(subtract(membrane_map(m, b2), a2), inverse);
    const real3 s0 = add(s1, s2);
    const real g_aa = x0.w * dot3(a0, a0) + x1.w * dot3(a1, a1) + x2.w * dot3(a2, a2);
    const real g_as = x0.w * dot3(a0, s0) + x1.w * dot3(a1, s1) + x2.w * dot3(a2, s2);
    const real g_ss = x0.w * dot3(s0, s0) + x1.w * dot3(s1, s1) + x2.w * dot3(s2, s2);
    const real a_a = inverse_h2 / lambda;
    const real a_s = inverse_h2 / mu;
    const real_pair change =
        solve_pair(g_aa, g_as, g_ss, a_a, a_s, strain.growth + a_a * area_multiplier,
                   shape_strain + a_s * shape_multiplier);

    store(of_area, i, area_multiplier + change.first);
    store(of_shape, i, shape_multiplier + change.second);
    const real3 push0 = add_scaled(scale(a0, change.first), s0, change.second);
    const real3 push1 = add_scaled(scale(a1, change.first), s1, change.second);
    const real3 push2 = add_scaled(scale(a2, change.first), s2, change.second);
    scatter4(positions, k0, with_w(add_scaled(xyz(x0), push0, -x0.w), x0.w));
    scatter4(positions, k1, with_w(add_scaled(xyz(x1), push1, x1.w), x1.w));
    scatter4(positions, k2, with_w(add_scaled(xyz(x2), push2, x2.w), x2.w));
}

WEFT_KERNELS_END

#endif
