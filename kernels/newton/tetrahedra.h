#ifndef WEFT_KERNELS_NEWTON_TETRAHEDRA_H
#define WEFT_KERNELS_NEWTON_TETRAHEDRA_H

#include "kernels/columns.h"
#include "kernels/energies/tetrahedron.h"
#include "kernels/newton/blocks.h"

WEFT_KERNELS_BEGIN

/// How a tetrahedron resists a change dF of F. With R the rotation nearest to F and s the size of
/// F / R, and D = R^T dF with its symmetric part S and the rest A,
///   2 d2J = s (tr(D)^2 - |S|^2 + |A|^2)
/// where F = s R, and nearly so where strains are small. Then the quadratic form is
///   (mu - p s) |S - tr(D)/3 I|^2 + (mu + p s) |A|^2 + (lambda + (mu + 2 p s) / (3 s^4)) (dJ)^2
/// of which no factor may be negative; at rest the second one is 0, as it must be for a rotation.
typedef struct {
    mat3 rotation;  ///< R; 0 where F is nearly flat or inverted
    real shear;     ///< mu - p s
    real turn;      ///< mu + p s
    real growth;    ///< of (dJ)^2
} tetrahedron_resistance;

/// R by Newton's method, R <- (R + R^-T) / 2, which has squared the error in every step when R
/// is near: (Higham 1986). Four steps are enough for stretches of a third to three.
WEFT_INLINE mat3 rotation_near(mat3 map, real inverse_size) {
    mat3 r = scale_mat(map, inverse_size);
    for (int k = 0; k < 4; ++k) {
        const mat3 c = cofactor_mat(r);
        const real inverse = splat(0.5f) / larger(dot3(r.x, c.x), splat(0.01f));
        r = add_mat(scale_mat(r, splat(0.5f)), scale_mat(c, inverse));
    }
    return r;
}

WEFT_INLINE tetrahedron_resistance resistance_of(tetrahedron t) {
    const real zero = splat(0.0f);
    const real third = splat(1.0f / 3.0f);
    const real square =
        third * (dot3(t.map.x, t.map.x) + dot3(t.map.y, t.map.y) + dot3(t.map.z, t.map.z));
    const real size = square_root(square);
    const real inverse = splat(1.0f) / divisor(size);
    const real ratio = t.jacobian * inverse * inverse * inverse;
    const real is_near = ratio > splat(0.1f) ? splat(1.0f) : zero;
    const real pressure = t.pressure * size;
    tetrahedron_resistance r;
    r.rotation = scale_mat(rotation_near(t.map, inverse), is_near);
    // Where there is no rotation to go by: mu |dF|^2 + lambda (dJ)^2.
    const real shear = larger(t.mu - pressure, zero);
    const real turn = larger(t.mu + pressure, zero);
    const real by_size =
        third * (t.mu + pressure + pressure) * inverse * inverse * inverse * inverse;
    r.shear = is_near > zero ? shear : t.mu;
    r.turn = is_near > zero ? turn : t.mu;
    r.growth = is_near > zero ? larger(t.lambda + by_size, zero) : t.lambda;
    return r;
}

/// The blocks of corners with shape gradients b_j and b_k [N/m].
WEFT_INLINE mat3 tetrahedron_clamped(tetrahedron t, tetrahedron_resistance r, real3 b_j,
                                     real3 b_k) {
    const real one_half = splat(0.5f);
    const real3 c_j = multiply_mat(t.cofactor, b_j);
    const real3 c_k = multiply_mat(t.cofactor, b_k);
    const real3 r_j = multiply_mat(r.rotation, b_j);
    const real3 r_k = multiply_mat(r.rotation, b_k);
    const mat3 growth = outer_mat(c_j, scale(c_k, r.growth));
    const mat3 trace = outer_mat(r_j, scale(r_k, r.shear * splat(-1.0f / 3.0f)));
    const mat3 crossed = outer_mat(r_k, scale(r_j, one_half * (r.shear - r.turn)));
    return add_diagonal_mat(add_mat(add_mat(growth, trace), crossed),
                            one_half * (r.shear + r.turn) * dot3(b_j, b_k));
}

/// The tetrahedra's blocks. Parameters as in couple_springs, and
/// corners   [4 * entries] column-major: v, w and the tetrahedron's other vertices
/// shape     [9 * entries] column-major: b of w and of the others [1/m]
/// material  [2 * entries] column-major: mu, lambda, times the rest volume [J]
WEFT_KERNEL(couple_tetrahedra, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* slices,
            WEFT_GLOBAL const int* corners, WEFT_GLOBAL const float* shape,
            WEFT_GLOBAL const float* material, WEFT_GLOBAL float* blocks, int block_count,
            int entry_count, int columns, int stride, int fresh) {
    mat3 sum = zero_mat();
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const real3 x0 = xyz(gather4(positions, load_index(corners, entry)));
        const real3 x1 =
            xyz(gather4(positions, load_index(corners, column(entry, entry_count, 1))));
        const real3 x2 =
            xyz(gather4(positions, load_index(corners, column(entry, entry_count, 2))));
        const real3 x3 =
            xyz(gather4(positions, load_index(corners, column(entry, entry_count, 3))));
        const real3 b1 = load3(shape, entry, entry_count, 0);
        const real3 b2 = load3(shape, entry, entry_count, 3);
        const real3 b3 = load3(shape, entry, entry_count, 6);
        const tetrahedron t =
            make_tetrahedron(tetrahedron_map(x0, x1, x2, x3, b1, b2, b3), load(material, entry),
                             load(material, column(entry, entry_count, 1)));
        const real3 b0 = scale(add(add(b1, b2), b3), splat(-1.0f));
        sum = add_mat(sum, tetrahedron_clamped(t, resistance_of(t), b0, b1));
    }
    put_block(blocks, i, block_count, columns, scale_mat(sum, splat(-1.0f)), fresh);
}

WEFT_KERNELS_END

#endif
