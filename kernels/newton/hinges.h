#ifndef WEFT_KERNELS_NEWTON_HINGES_H
#define WEFT_KERNELS_NEWTON_HINGES_H

#include "kernels/energies/curved_hinge.h"
#include "kernels/newton/blocks.h"

WEFT_KERNELS_BEGIN

/// Quadratic bending has constant blocks, multiples of I.
/// weights  [blocks] -Q_vw of descent/hinges.h [N/m], or their sum; blocks and so on as in
///          couple_springs
WEFT_KERNEL(couple_hinges, WEFT_GLOBAL const float* weights, WEFT_GLOBAL float* blocks,
            int block_count, int columns, int fresh) {
    put_block(blocks, i, block_count, columns, add_diagonal_mat(zero_mat(), load(weights, i)),
              fresh);
}

/// A curved hinge as two of its corners see it, j and k, the others being l and m.
/// weights  [7 * entries] column-major: q_j, q_k, p_jk, p_jl, p_jm, p_kl, p_km of
///          energies/curved_hinge.h
/// -J_j^T J_k: what is left of the Hessian without the bend's own part, which may be indefinite.
/// v_j = -sum_k p_jk y_k: a corner's pairs add up to 0, so y may count from any corner.
WEFT_INLINE mat3 curved_hinge_contribution(WEFT_GLOBAL const float* weights, item entry,
                                           int entry_count, real3 y_k, real3 y_l, real3 y_m) {
    const real3 zero = make3(splat(0.0f), splat(0.0f), splat(0.0f));
    const real p_jk = load(weights, column(entry, entry_count, 2));
    const real3 v_j = add_scaled(
        add_scaled(scale(y_k, -p_jk), y_l, -load(weights, column(entry, entry_count, 3))), y_m,
        -load(weights, column(entry, entry_count, 4)));
    const real3 v_k = add_scaled(scale(y_l, -load(weights, column(entry, entry_count, 5))), y_m,
                                 -load(weights, column(entry, entry_count, 6)));
    return curved_hinge_coupling(zero, load(weights, entry), v_j,
                                 load(weights, column(entry, entry_count, 1)), v_k, p_jk);
}

/// Parameters as in couple_springs, and
/// corners  [4 * entries] column-major: v, w and the hinge's other two
/// weights  [7 * entries] see curved_hinge_contribution
WEFT_KERNEL(couple_curved_hinges, WEFT_GLOBAL const float4* positions,
            WEFT_GLOBAL const int* slices, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* weights, WEFT_GLOBAL float* blocks, int block_count,
            int entry_count, int columns, int stride, int fresh) {
    mat3 sum = zero_mat();
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const real3 x = xyz(gather4(positions, load_index(corners, entry)));
        const real3 y_k = subtract(
            xyz(gather4(positions, load_index(corners, column(entry, entry_count, 1)))), x);
        const real3 y_l = subtract(
            xyz(gather4(positions, load_index(corners, column(entry, entry_count, 2)))), x);
        const real3 y_m = subtract(
            xyz(gather4(positions, load_index(corners, column(entry, entry_count, 3)))), x);
        sum = add_mat(sum, curved_hinge_contribution(weights, entry, entry_count, y_k, y_l, y_m));
    }
    put_block(blocks, i, block_count, columns, scale_mat(sum, splat(-1.0f)), fresh);
}

WEFT_KERNELS_END

#endif
