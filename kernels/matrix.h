#ifndef WEFT_KERNELS_MATRIX_H
#define WEFT_KERNELS_MATRIX_H

// 3x3 matrices on `real`: symmetric ones (sym3) are Hessian blocks of one vertex; general ones
// (mat3) are deformation gradients and Hessian blocks of two vertices.

#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

typedef struct {
    real xx, xy, xz, yy, yz, zz;
} sym3;

WEFT_INLINE sym3 make_sym(real xx, real xy, real xz, real yy, real yz, real zz) {
    sym3 a = {xx, xy, xz, yy, yz, zz};
    return a;
}

/// s I
WEFT_INLINE sym3 diagonal_sym(real s) {
    const real zero = splat(0.0f);
    return make_sym(s, zero, zero, s, zero, s);
}

/// s v v^T
WEFT_INLINE sym3 outer_sym(real3 v, real s) {
    const real3 sv = scale(v, s);
    return make_sym(sv.x * v.x, sv.x * v.y, sv.x * v.z, sv.y * v.y, sv.y * v.z, sv.z * v.z);
}

WEFT_INLINE sym3 add_sym(sym3 a, sym3 b) {
    return make_sym(a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz);
}

WEFT_INLINE sym3 scale_sym(sym3 a, real s) {
    return make_sym(a.xx * s, a.xy * s, a.xz * s, a.yy * s, a.yz * s, a.zz * s);
}

/// a + s I
WEFT_INLINE sym3 add_diagonal(sym3 a, real s) {
    return make_sym(a.xx + s, a.xy, a.xz, a.yy + s, a.yz, a.zz + s);
}

WEFT_INLINE real3 multiply_sym(sym3 a, real3 v) {
    return make3(a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
                 a.xz * v.x + a.yz * v.y + a.zz * v.z);
}

WEFT_INLINE real trace_sym(sym3 a) { return a.xx + a.yy + a.zz; }

/// L D L^T of a positive semi-definite matrix: L below its diagonal of ones, and 1 / D
typedef struct {
    real l_yx, l_zx, l_zy;
    real inverse_x, inverse_y, inverse_z;
} sym3_factors;

/// Pivots below the least one are lifted to that.
WEFT_INLINE sym3_factors factor_sym_above(sym3 a, real least) {
    sym3_factors f;
    f.inverse_x = splat(1.0f) / larger(a.xx, least);
    f.l_yx = a.xy * f.inverse_x;
    f.l_zx = a.xz * f.inverse_x;
    f.inverse_y = splat(1.0f) / larger(a.yy - f.l_yx * a.xy, least);
    const real yz = a.yz - f.l_yx * a.xz;
    f.l_zy = yz * f.inverse_y;
    f.inverse_z = splat(1.0f) / larger(a.zz - f.l_zx * a.xz - f.l_zy * yz, least);
    return f;
}

/// A pivot that rounding made tiny or negative is lifted to 2e-7 of the trace: what counts as
/// singular has no unit, so light materials and stiff ones are solved alike, and solutions have
/// x^T b >= 0 always.
WEFT_INLINE sym3_factors factor_sym(sym3 a) {
    return factor_sym_above(a, larger(trace_sym(a) * splat(2e-7f), splat(1e-30f)));
}

WEFT_INLINE real3 solve_factored(sym3_factors f, real3 b) {
    const real y = b.y - f.l_yx * b.x;
    const real z = b.z - f.l_zx * b.x - f.l_zy * y;
    const real solution_z = z * f.inverse_z;
    const real solution_y = y * f.inverse_y - f.l_zy * solution_z;
    const real solution_x = b.x * f.inverse_x - f.l_yx * solution_y - f.l_zx * solution_z;
    return make3(solution_x, solution_y, solution_z);
}

/// Solves a x = b for a positive semi-definite `a`.
WEFT_INLINE real3 solve_sym(sym3 a, real3 b) { return solve_factored(factor_sym(a), b); }

/// By columns.
typedef struct {
    real3 x, y, z;
} mat3;

WEFT_INLINE mat3 make_mat(real3 x, real3 y, real3 z) {
    mat3 a = {x, y, z};
    return a;
}

WEFT_INLINE mat3 add_mat(mat3 a, mat3 b) {
    return make_mat(add(a.x, b.x), add(a.y, b.y), add(a.z, b.z));
}

/// a + s I
WEFT_INLINE mat3 add_diagonal_mat(mat3 a, real s) {
    a.x.x = a.x.x + s;
    a.y.y = a.y.y + s;
    a.z.z = a.z.z + s;
    return a;
}

/// a b^T
WEFT_INLINE mat3 outer_mat(real3 a, real3 b) {
    return make_mat(scale(a, b.x), scale(a, b.y), scale(a, b.z));
}

/// [w]_x, by which a vector v becomes w x v
WEFT_INLINE mat3 cross_mat(real3 w) {
    const real zero = splat(0.0f);
    return make_mat(make3(zero, w.z, -w.y), make3(-w.z, zero, w.x), make3(w.y, -w.x, zero));
}

/// The derivative of the determinant; det(a) a^-T where there is an inverse.
WEFT_INLINE mat3 cofactor_mat(mat3 a) {
    return make_mat(cross3(a.y, a.z), cross3(a.z, a.x), cross3(a.x, a.y));
}

WEFT_INLINE real3 multiply_mat(mat3 a, real3 v) {
    return add_scaled(add_scaled(scale(a.x, v.x), a.y, v.y), a.z, v.z);
}

/// a^T v
WEFT_INLINE real3 multiply_transposed_mat(mat3 a, real3 v) {
    return make3(dot3(a.x, v), dot3(a.y, v), dot3(a.z, v));
}

WEFT_KERNELS_END

#endif
