#ifndef WEFT_KERNELS_ENERGIES_TETRAHEDRON_H
#define WEFT_KERNELS_ENERGIES_TETRAHEDRON_H

// A tetrahedron of stable Neo-Hookean material without the logarithm (Smith, de Goes and Kim 2018;
// Macklin and Mueller 2021). With F the deformation gradient, J = det F:
//   E = mu/2 (|F|^2 - 3) - mu (J - 1) + lambda/2 (J - 1)^2
// which is mu/2 |F|^2 + lambda/2 (J - a)^2, a = 1 + mu/lambda, less its value at rest. Small
// deformations are those of linear elasticity with Lame's mu_L = mu and lambda_L = lambda - mu;
// mu and lambda here are multiplied by the rest volume [J].
//
// The shape at rest is given by the gradients b_1, b_2, b_3 [1/m] of the corners' barycentric
// coordinates; b_0 = -(b_1 + b_2 + b_3). Then F = sum_j x_j b_j^T, and with c_j = cof(F) b_j =
// dJ/dx_j and p = dE/dJ = lambda (J - 1) - mu:
//   dE/dx_j = mu F b_j + p c_j
//   d2E/dx_jdx_j = mu |b_j|^2 I + lambda c_j c_j^T      positive semi-definite, even if inverted
//   d2E/dx_jdx_k = mu (b_j . b_k) I + lambda c_j c_k^T - p [F (b_j x b_k)]_x
// All of it is polynomial: defined for flat, inverted and collapsed tetrahedra alike. A tetrahedron
// that is collapsed to a line or a point has no volume gradient, and to a point no force.

#include "kernels/matrix.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// A tetrahedron as it is deformed.
typedef struct {
    mat3 map;       ///< F
    mat3 cofactor;  ///< of F
    real jacobian;  ///< J
    real mu, lambda;
    real pressure;  ///< p
} tetrahedron;

/// F for corners x_j [m]
WEFT_INLINE mat3 tetrahedron_map(real3 x0, real3 x1, real3 x2, real3 x3, real3 b1, real3 b2,
                                 real3 b3) {
    const real3 e1 = subtract(x1, x0);
    const real3 e2 = subtract(x2, x0);
    const real3 e3 = subtract(x3, x0);
    return make_mat(add_scaled(add_scaled(scale(e1, b1.x), e2, b2.x), e3, b3.x),
                    add_scaled(add_scaled(scale(e1, b1.y), e2, b2.y), e3, b3.y),
                    add_scaled(add_scaled(scale(e1, b1.z), e2, b2.z), e3, b3.z));
}

WEFT_INLINE tetrahedron make_tetrahedron(mat3 map, real mu, real lambda) {
    tetrahedron t;
    t.map = map;
    t.cofactor = cofactor_mat(map);
    t.jacobian = dot3(map.x, t.cofactor.x);
    t.mu = mu;
    t.lambda = lambda;
    t.pressure = lambda * (t.jacobian - splat(1.0f)) - mu;
    return t;
}

/// What the energy is made of: E = mu/2 shape + lambda/2 growth^2.
typedef struct {
    real shape;   ///< |F|^2 - 3 - 2 (J - 1)
    real growth;  ///< J - 1
} tetrahedron_strain;

/// With e = (F^T F - I) / 2, t = tr e, m the sum of its principal minors and d = det e:
///   |F|^2 - 3 = 2 t     J^2 - 1 = 2 t + 4 m + 8 d
/// so shape = (2 t (J - 1) - 8 m - 16 d) / (J + 1), in which the terms that are linear in the
/// strain have cancelled, and not by rounding. It serves where J > 0.
WEFT_INLINE tetrahedron_strain strain_of_tetrahedron(mat3 map, real jacobian) {
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const real one_half = splat(0.5f);
    const real xx = one_half * (dot3(map.x, map.x) - one);
    const real yy = one_half * (dot3(map.y, map.y) - one);
    const real zz = one_half * (dot3(map.z, map.z) - one);
    const real xy = one_half * dot3(map.x, map.y);
    const real xz = one_half * dot3(map.x, map.z);
    const real yz = one_half * dot3(map.y, map.z);
    const real trace = xx + yy + zz;
    const real minor_x = yy * zz - yz * yz;
    const real minors = minor_x + (xx * zz - xz * xz) + (xx * yy - xy * xy);
    const real det = xx * minor_x - xy * (xy * zz - xz * yz) + xz * (xy * yz - yy * xz);

    const real inverse = one / (one + larger(jacobian, zero));
    const real small_growth =
        (splat(2.0f) * trace + splat(4.0f) * minors + splat(8.0f) * det) * inverse;
    const real small_shape =
        (splat(2.0f) * trace * small_growth - splat(8.0f) * minors - splat(16.0f) * det) * inverse;
    tetrahedron_strain strain;
    strain.growth = jacobian > zero ? small_growth : jacobian - one;
    strain.shape = jacobian > zero ? small_shape : splat(2.0f) * (trace - strain.growth);
    return strain;
}

/// [J]
WEFT_INLINE real tetrahedron_energy(tetrahedron t) {
    const tetrahedron_strain strain = strain_of_tetrahedron(t.map, t.jacobian);
    return splat(0.5f) * (t.mu * strain.shape + t.lambda * strain.growth * strain.growth);
}

/// dE/dx_j [N] of the corner with shape gradient b
WEFT_INLINE real3 tetrahedron_gradient(tetrahedron t, real3 b) {
    return add_scaled(scale(multiply_mat(t.map, b), t.mu), multiply_mat(t.cofactor, b), t.pressure);
}

/// d2E/dx_jdx_j [N/m] of the corner with shape gradient b
WEFT_INLINE sym3 tetrahedron_hessian(tetrahedron t, real3 b) {
    return add_diagonal(outer_sym(multiply_mat(t.cofactor, b), t.lambda), t.mu * dot3(b, b));
}

/// mu (b_j . b_k) I + lambda c_j c_k^T [N/m], of corners with shape gradients b_j and b_k: for all
/// corners together a sum of a Gram matrix and a dyad, so positive semi-definite, and with the
/// exact blocks on its diagonal
WEFT_INLINE mat3 tetrahedron_coupling(tetrahedron t, real3 b_j, real3 b_k) {
    const real3 c_j = multiply_mat(t.cofactor, b_j);
    const real3 c_k = multiply_mat(t.cofactor, b_k);
    return add_diagonal_mat(outer_mat(c_j, scale(c_k, t.lambda)), t.mu * dot3(b_j, b_k));
}

/// d2E/dx_jdx_k [N/m]; the exact one, which as part of a larger matrix is not always positive
/// semi-definite
WEFT_INLINE mat3 tetrahedron_block(tetrahedron t, real3 b_j, real3 b_k) {
    const real3 turn = scale(multiply_mat(t.map, cross3(b_j, b_k)), -t.pressure);
    return add_mat(tetrahedron_coupling(t, b_j, b_k), cross_mat(turn));
}

WEFT_KERNELS_END

#endif
