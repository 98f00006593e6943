#ifndef WEFT_KERNELS_NEWTON_TRIANGLES_H
#define WEFT_KERNELS_NEWTON_TRIANGLES_H

#include "kernels/energies/membrane.h"
#include "kernels/energies/woven.h"
#include "kernels/newton/blocks.h"
#include "kernels/triangles.h"

WEFT_KERNELS_BEGIN

/// A membrane's Hessian, its negative curvature taken away. In the sheet's plane the quadratic form
/// of a change dF of F is mu |dF|^2 + 2 p det dF + lambda (dJ)^2. dF is the sum of a part a that
/// turns and scales, and of one that does so after a reflection, b, and
///   |dF|^2 = |a|^2 + |b|^2       2 det dF = |a|^2 - |b|^2
/// so it is (mu + p) |a|^2 + (mu - p) |b|^2 + lambda (dJ)^2, and what is negative of the two
/// factors is left out; at rest the first one is 0, as it must be for a rotation. Along the normal
/// it is as in membrane_coupling().
WEFT_INLINE mat3 membrane_clamped(membrane m, real2 b_j, real2 b_k) {
    const real zero = splat(0.0f);
    const real one_half = splat(0.5f);
    const real turning = larger(m.mu + m.pressure, zero);
    const real mirrored = larger(m.mu - m.pressure, zero);
    const real3 c_j = membrane_growth(m, b_j);
    const real3 c_k = membrane_growth(m, b_k);
    const real in_plane = one_half * (turning + mirrored) * dot2(b_j, b_k);
    const real turn = one_half * (mirrored - turning) * (b_j.u * b_k.v - b_j.v * b_k.u);
    const real taut = m.mu * dot2(b_j, b_k) + m.pressure * dot3(c_j, c_k) / divisor(m.jacobian);
    const real out = (membrane_tautness(m) > zero ? taut : zero) - in_plane;
    const mat3 across =
        add_mat(outer_mat(m.normal, scale(m.normal, out)), cross_mat(scale(m.normal, turn)));
    return add_diagonal_mat(add_mat(outer_mat(c_j, scale(c_k, m.lambda)), across), in_plane);
}

/// The membranes' blocks. Parameters as in couple_springs, and
/// corners   [3 * entries] column-major: v, w and the triangle's third vertex
/// shape     [4 * entries] column-major: b of w and of the third vertex [1/m]
/// material  [2 * entries] column-major: mu, lambda, times the rest area [J]
WEFT_KERNEL(couple_membranes, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* slices,
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
        const triangle_shape t = load_triangle_shape(shape, entry, entry_count);
        const membrane m = make_membrane(x0, x1, x2, t.b[1], t.b[2], load(material, entry),
                                         load(material, column(entry, entry_count, 1)));
        sum = add_mat(sum, membrane_clamped(m, t.b[0], t.b[1]));
    }
    put_block(blocks, i, block_count, columns, scale_mat(sum, splat(-1.0f)), fresh);
}

/// The same of woven cloth.
/// material  [3 * entries] column-major: warp, weft, shear, times the rest area [J]
WEFT_KERNEL(couple_woven, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* slices,
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
        const triangle_shape t = load_triangle_shape(shape, entry, entry_count);
        const woven w = make_woven(x0, x1, x2, t.b[1], t.b[2], load(material, entry),
                                   load(material, column(entry, entry_count, 1)),
                                   load(material, column(entry, entry_count, 2)));
        sum = add_mat(sum, woven_coupling(w, t.b[0], t.b[1]));
    }
    put_block(blocks, i, block_count, columns, scale_mat(sum, splat(-1.0f)), fresh);
}

WEFT_KERNELS_END

#endif
