#ifndef WEFT_KERNELS_DESCENT_GATHER_BENDING_H
#define WEFT_KERNELS_DESCENT_GATHER_BENDING_H

#include "kernels/descent/rows.h"

WEFT_KERNELS_BEGIN

/// Adds the hinges' part of each vertex' slope. Quadratic bending is E = 1/2 x^T Q x with a
/// constant Q, the sum of all hinges' q_j q_k (energies/hinge.h); a row of Q has half as many
/// entries as the hinges at its vertex have other corners. Rows of Q add up to 0, so
///   dE/dx_v = sum_w Q_vw (x_w - x_v)      d2E/dx_v^2 = Q_vv I
/// Parameters as in gather_springs, and
/// others    [entries] w
/// weights   [entries] Q_vw [N/m]
/// diagonal  [items] Q_vv [N/m]
WEFT_KERNEL(gather_bending, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* vertices,
            WEFT_GLOBAL const int* slices, WEFT_GLOBAL const int* others,
            WEFT_GLOBAL const float* weights, WEFT_GLOBAL const float* diagonal,
            WEFT_GLOBAL float* sums, int item_count, int stride, int fresh) {
    slope s = fresh ? no_slope() : load_slope(sums, i, item_count);
    const real3 x = xyz(gather4(positions, load_index(vertices, i)));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const real3 other = xyz(gather4(positions, load_index(others, entry)));
        s.gradient = add_scaled(s.gradient, subtract(other, x), load(weights, entry));
    }
    s.hessian = add_diagonal(s.hessian, load(diagonal, i));
    store_slope(sums, i, item_count, s);
}

WEFT_KERNELS_END

#endif
