#ifndef WEFT_KERNELS_XPBD_TETRAHEDRA_H
#define WEFT_KERNELS_XPBD_TETRAHEDRA_H

#include "kernels/columns.h"
#include "kernels/energies/tetrahedron.h"
#include "kernels/platform.h"
#include "kernels/vector.h"
#include "kernels/xpbd/pair.h"

WEFT_KERNELS_BEGIN

/// Projects tetrahedra of stable Neo-Hookean material (kernels/energies/tetrahedron.h) as two XPBD
/// constraints at once: its energy is mu/2 S^2 + (lambda - mu)/2 (J - 1)^2 with
///   S^2 = |F|^2 - 3 - 2 (J - 1) + (J - 1)^2
/// which is never negative (inequality of means), so S has compliance 1/mu and J - 1 has 1/(lambda
/// - mu). Both vanish at rest. Macklin and Mueller 2021 take |F| and J - 1 - mu/lambda instead.
/// Those hold each other in balance at rest, and resist shear only by their multipliers, which no
/// compliance limits: tried here, stiff sheets blew up from rest. Where lambda < mu (a negative
/// Poisson's ratio), S^2 has only lambda/mu of (J - 1)^2, and is taken as 0 where that is too
/// little.
///
/// positions    [vertices] xyz [m], w = 1/mass [1/kg]; read and written
/// corners      [4 * count] column-major
/// shape        [9 * count] column-major: b_1, b_2, b_3 [1/m]
/// material     [2 * count] column-major: mu, lambda, times the rest volume [J]
/// of_volume, of_shape  [count] multipliers of J - 1 and of S; taken as 0 where `fresh`
/// inverse_h2   1 / h^2 [1/s^2], h the substep
/// fresh        1 in the first iteration of a substep, else 0
/// Tetrahedra of one call share no vertex.
WEFT_KERNEL(project_tetrahedra, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* shape, WEFT_GLOBAL const float* material,
            WEFT_GLOBAL float* of_volume, WEFT_GLOBAL float* of_shape, int count, float inverse_h2,
            int fresh) {
    const integer k0 = load_index(corners, i);
    const integer k1 = load_index(corners, column(i, count, 1));
    const integer k2 = load_index(corners, column(i, count, 2));
    const integer k3 = load_index(corners, column(i, count, 3));
    const real3 b1 = load3(shape, i, count, 0);
    const real3 b2 = load3(shape, i, count, 3);
    const real3 b3 = load3(shape, i, count, 6);
    const real mu = load(material, i);
    const real lambda = load(material, column(i, count, 1));
    const real volume_multiplier = fresh ? splat(0.0f) : load(of_volume, i);
    const real shape_multiplier = fresh ? splat(0.0f) : load(of_shape, i);
    const real4 x0 = gather4(positions, k0);
    const real4 x1 = gather4(positions, k1);
    const real4 x2 = gather4(positions, k2);
    const real4 x3 = gather4(positions, k3);

    const mat3 map = tetrahedron_map(xyz(x0), xyz(x1), xyz(x2), xyz(x3), b1, b2, b3);
    const mat3 cofactor = cofactor_mat(map);
    const real jacobian = dot3(map.x, cofactor.x);
    const tetrahedron_strain strain = strain_of_tetrahedron(map, jacobian);
    const real part = smaller(lambda / mu, splat(1.0f));  // of (J - 1)^2, in S^2
    const real shape_strain =
        square_root(larger(strain.shape + part * strain.growth * strain.growth, splat(0.0f)));
    const real inverse = inverse_strain(shape_strain);
    const real balance = part * strain.growth - splat(1.0f);  // S dS = F : dF + balance dJ
    // Gradients of both constraints at the corners 1 to 3; corner 0 balances them.
    const real3 v1 = multiply_mat(cofactor, b1);
    const real3 v2 = multiply_mat(cofactor, b2);
    const real3 v3 = multiply_mat(cofactor, b3);
    const real3 v0 = add(add(v1, v2), v3);
    const real3 s1 = scale(add_scaled(multiply_mat(map, b1), v1, balance), inverse);
    const real3 s2 = scale(add_scaled(multiply_mat(map, b2), v2, balance), inverse);
    const real3 s3 = scale(add_scaled(multiply_mat(map, b3), v3, balance), inverse);
    const real3 s0 = add(add(s1, s2), s3);
    const real g_vv =
        (x0.w * dot3(v0, v0) + x1.w * dot3(v1, v1)) + (x2.w * dot3(v2, v2) + x3.w * dot3(v3, v3));
    const real g_vs =
        (x0.w * dot3(v0, s0) + x1.w * dot3(v1, s1)) + (x2.w * dot3(v2, s2) + x3.w * dot3(v3, s3));
    const real g_ss =
        (x0.w * dot3(s0, s0) + x1.w * dot3(s1, s1)) + (x2.w * dot3(s2, s2) + x3.w * dot3(s3, s3));
    const real a_v = inverse_h2 / larger(lambda - part * mu, splat(1e-6f) * mu);
    const real a_s = inverse_h2 / mu;
    const real_pair change =
        solve_pair(g_vv, g_vs, g_ss, a_v, a_s, strain.growth + a_v * volume_multiplier,
                   shape_strain + a_s * shape_multiplier);

    store(of_volume, i, volume_multiplier + change.first);
    store(of_shape, i, shape_multiplier + change.second);
    const real3 push0 = add_scaled(scale(v0, change.first), s0, change.second);
    const real3 push1 = add_scaled(scale(v1, change.first), s1, change.second);
    const real3 push2 = add_scaled(scale(v2, change.first), s2, change.second);
    const real3 push3 = add_scaled(scale(v3, change.first), s3, change.second);
    scatter4(positions, k0, with_w(add_scaled(xyz(x0), push0, -x0.w), x0.w));
    scatter4(positions, k1, with_w(add_scaled(xyz(x1), push1, x1.w), x1.w));
    scatter4(positions, k2, with_w(add_scaled(xyz(x2), push2, x2.w), x2.w));
    scatter4(positions, k3, with_w(add_scaled(xyz(x3), push3, x3.w), x3.w));
}

WEFT_KERNELS_END

#endif
