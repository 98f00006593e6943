#ifndef WEFT_KERNELS_DESCENT_HINGES_H
#define WEFT_KERNELS_DESCENT_HINGES_H

#include "kernels/descent/energy_terms.h"
#include "kernels/descent/rows.h"
#include "kernels/energies/hinge.h"

WEFT_KERNELS_BEGIN

/// Adds the hinges' part of each vertex' gradient and Hessian block. Quadratic bending is E = 1/2
/// x^T Q x with a constant Q, the sum of all hinges' q_j q_k (energies/hinge.h); a row of Q has
/// half as many entries as the hinges at its vertex have other corners. Rows of Q add up to 0, so
///   dE/dx_v = sum_w Q_vw (x_w - x_v)      d2E/dx_v^2 = Q_vv I
/// Parameters as in gather_springs, and
/// others    [entries] w
/// weights   [entries] Q_vw [N/m]
/// diagonal  [items] Q_vv [N/m]
WEFT_KERNEL(gather_bending, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* vertices,
            WEFT_GLOBAL const int* slices, WEFT_GLOBAL const int* others,
            WEFT_GLOBAL const float* weights, WEFT_GLOBAL const float* diagonal,
            WEFT_GLOBAL float* sums, int item_count, int stride, int fresh) {
    derivatives s = fresh ? zero_derivatives() : load_derivatives(sums, i, item_count);
    const real3 x = xyz(gather4(positions, load_index(vertices, i)));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const real3 other = xyz(gather4(positions, load_index(others, entry)));
        s.gradient = add_scaled(s.gradient, subtract(other, x), load(weights, entry));
    }
    s.hessian = add_diagonal(s.hessian, load(diagonal, i));
    store_derivatives(sums, i, item_count, s);
}

/// Only the gradients. Parameters as in gather_bending, without the diagonal.
WEFT_KERNEL(gather_bending_gradients, WEFT_GLOBAL const float4* positions,
            WEFT_GLOBAL const int* vertices, WEFT_GLOBAL const int* slices,
            WEFT_GLOBAL const int* others, WEFT_GLOBAL const float* weights,
            WEFT_GLOBAL float* sums, int item_count, int stride, int fresh) {
    real3 gradient = make3(splat(0.0f), splat(0.0f), splat(0.0f));
    if (!fresh) gradient = load_gradient(sums, i, item_count);
    const real3 x = xyz(gather4(positions, load_index(vertices, i)));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const real3 other = xyz(gather4(positions, load_index(others, entry)));
        gradient = add_scaled(gradient, subtract(other, x), load(weights, entry));
    }
    store_gradient(sums, i, item_count, gradient);
}

/// Each hinge's energy. corners, weights as in project_hinges
WEFT_KERNEL(hinge_terms, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* weights, WEFT_GLOBAL const int* slots,
            WEFT_GLOBAL float* terms, int hinge_count) {
    const real3 x0 = xyz(gather4(positions, load_index(corners, i)));
    const real3 x1 = xyz(gather4(positions, load_index(corners, column(i, hinge_count, 1))));
    const real3 x2 = xyz(gather4(positions, load_index(corners, column(i, hinge_count, 2))));
    const real3 x3 = xyz(gather4(positions, load_index(corners, column(i, hinge_count, 3))));
    const real3 bend = hinge_bend(x0, x1, x2, x3, load(weights, column(i, hinge_count, 1)),
                                  load(weights, column(i, hinge_count, 2)),
                                  load(weights, column(i, hinge_count, 3)));
    store_term(terms, slots, i, hinge_energy(bend));
}

WEFT_KERNELS_END

#endif
