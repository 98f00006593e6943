#ifndef WEFT_KERNELS_ENERGIES_MEMBRANE_H
#define WEFT_KERNELS_ENERGIES_MEMBRANE_H

// A triangle of a thin sheet of stable Neo-Hookean material, which resists stretch and shear in its
// plane: tetrahedron.h one dimension lower. F is 3x2; J = |f_u x f_v| >= 0 is the ratio of the
// areas:
//   E = mu/2 (|F|^2 - 2) - mu (J - 1) + lambda/2 (J - 1)^2
// With mu = E t / (2 (1 + nu)) and lambda = mu (1 + nu) / (1 - nu) small deformations are those of
// plane stress, for Young's modulus E, Poisson's ratio nu and thickness t; a strip that is
// stretched by L has the area 2 L^2 / ((1 - nu) + (1 + nu) L^2). Here mu and lambda are multiplied
// by the rest area [J].
//
// The shape at rest is given by the gradients b_1, b_2 [1/m] of the corners' barycentric
// coordinates in the plane; b_0 = -(b_1 + b_2). With g_j = b_ju f_v - b_jv f_u, the unit normal n,
// c_j = g_j x n = dJ/dx_j and p = dE/dJ = lambda (J - 1) - mu:
//   dE/dx_j = mu F b_j + p c_j
//   d2E/dx_jdx_k = mu (b_j . b_k) I + lambda c_j c_k^T
//                  + p ((c_j . c_k) / J n n^T - (b_ju b_kv - b_jv b_ku) [n]_x)
// A block j = k is indefinite only along n, where a compressed sheet buckles; there it is lifted to
// 0. A triangle without area has no normal: n = 0 then, and only mu's part remains, which pulls it
// together.

#include "kernels/energies/triangle.h"
#include "kernels/matrix.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// A triangle as it is deformed.
typedef struct {
    real3 u, v;     ///< columns of F
    real3 normal;   ///< n
    real jacobian;  ///< J
    real mu, lambda;
    real pressure;  ///< p
} membrane;

/// For corners x_j [m]
WEFT_INLINE membrane make_membrane(real3 x0, real3 x1, real3 x2, real2 b1, real2 b2, real mu,
                                   real lambda) {
    const real3 e1 = subtract(x1, x0);
    const real3 e2 = subtract(x2, x0);
    membrane m;
    m.u = add_scaled(scale(e1, b1.u), e2, b2.u);
    m.v = add_scaled(scale(e1, b1.v), e2, b2.v);
    const real3 area = cross3(m.u, m.v);
    m.jacobian = length3(area);
    m.normal = scale(area, splat(1.0f) / divisor(m.jacobian));
    m.mu = mu;
    m.lambda = lambda;
    m.pressure = lambda * (m.jacobian - splat(1.0f)) - mu;
    return m;
}

/// dJ/dx_j [1/m]
WEFT_INLINE real3 membrane_growth(membrane m, real2 b) {
    return cross3(subtract(scale(m.v, b.u), scale(m.u, b.v)), m.normal);
}

WEFT_INLINE real3 membrane_map(membrane m, real2 b) {
    return add_scaled(scale(m.u, b.u), m.v, b.v);
}

/// What the energy is made of: E = mu/2 shape + lambda/2 growth^2.
typedef struct {
    real shape;   ///< |F|^2 - 2 J, the square of the principal stretches' difference
    real growth;  ///< J - 1
} membrane_strain;

/// Without the cancellation of linear terms, see strain_of_tetrahedron().
WEFT_INLINE membrane_strain strain_of_membrane(membrane m) {
    const real one = splat(1.0f);
    const real one_half = splat(0.5f);
    const real uu = one_half * (dot3(m.u, m.u) - one);
    const real vv = one_half * (dot3(m.v, m.v) - one);
    const real uv = one_half * dot3(m.u, m.v);
    const real trace = uu + vv;
    const real det = uu * vv - uv * uv;
    const real inverse = one / (m.jacobian + one);
    membrane_strain strain;
    strain.growth = (splat(2.0f) * trace + splat(4.0f) * det) * inverse;
    strain.shape = (splat(2.0f) * trace * strain.growth - splat(8.0f) * det) * inverse;
    return strain;
}

/// [J]
WEFT_INLINE real membrane_energy(membrane m) {
    const membrane_strain strain = strain_of_membrane(m);
    return splat(0.5f) * (m.mu * strain.shape + m.lambda * strain.growth * strain.growth);
}

/// dE/dx_j [N] of the corner with shape gradient b
WEFT_INLINE real3 membrane_gradient(membrane m, real2 b) {
    return add_scaled(scale(membrane_map(m, b), m.mu), membrane_growth(m, b), m.pressure);
}

/// d2E/dx_jdx_j [N/m] of the corner with shape gradient b, projected to positive semi-definite
WEFT_INLINE sym3 membrane_hessian(membrane m, real2 b) {
    const real3 c = membrane_growth(m, b);
    const real stiffness = m.mu * dot2(b, b);
    const real buckling = m.pressure * dot3(c, c) / divisor(m.jacobian);
    return add_diagonal(
        add_sym(outer_sym(c, m.lambda), outer_sym(m.normal, larger(buckling, -stiffness))),
        stiffness);
}

/// Not negative where the sheet resists all movements along n. There d2E is b_j^T (mu I + p J C^-1)
/// b_k with C = F^T F; this is 2 J times the lower eigenvalue of the matrix in between, which is
/// mu + p s / J, with s the square of the largest stretch.
WEFT_INLINE real membrane_tautness(membrane m) {
    const real squares = dot3(m.u, m.u) + dot3(m.v, m.v);
    const real spread = squares * squares - splat(4.0f) * m.jacobian * m.jacobian;
    const real twice_s = squares + square_root(larger(spread, splat(0.0f)));
    return splat(2.0f) * m.mu * m.jacobian + m.pressure * twice_s;
}

/// Of corners with shape gradients b_j and b_k [N/m], so that the blocks of all corners together,
/// with membrane_hessian() on the diagonal, are positive semi-definite: without the part with
/// [n]_x, and movements along n couple only where the sheet
/// is taut.
WEFT_INLINE mat3 membrane_coupling(membrane m, real2 b_j, real2 b_k) {
    const real3 c_j = membrane_growth(m, b_j);
    const real3 c_k = membrane_growth(m, b_k);
    const real stiffness = m.mu * dot2(b_j, b_k);
    const real buckling = m.pressure * dot3(c_j, c_k) / divisor(m.jacobian);
    const real out = membrane_tautness(m) > splat(0.0f) ? buckling : -stiffness;
    return add_diagonal_mat(
        add_mat(outer_mat(c_j, scale(c_k, m.lambda)), outer_mat(m.normal, scale(m.normal, out))),
        stiffness);
}

/// d2E/dx_jdx_k [N/m], of corners with shape gradients b_j and b_k; the exact one
WEFT_INLINE mat3 membrane_block(membrane m, real2 b_j, real2 b_k) {
    const real3 c_j = membrane_growth(m, b_j);
    const real3 c_k = membrane_growth(m, b_k);
    const real out = m.pressure * dot3(c_j, c_k) / divisor(m.jacobian);
    const real turn = -m.pressure * (b_j.u * b_k.v - b_j.v * b_k.u);
    const mat3 across =
        add_mat(outer_mat(m.normal, scale(m.normal, out)), cross_mat(scale(m.normal, turn)));
    return add_diagonal_mat(add_mat(outer_mat(c_j, scale(c_k, m.lambda)), across),
                            m.mu * dot2(b_j, b_k));
}

WEFT_KERNELS_END

#endif
