#ifndef WEFT_KERNELS_DESCENT_CURVED_HINGES_H
#define WEFT_KERNELS_DESCENT_CURVED_HINGES_H

#include "kernels/curved_hinge_weights.h"
#include "kernels/descent/energy_terms.h"
#include "kernels/descent/rows.h"
#include "kernels/energies/curved_hinge.h"

WEFT_KERNELS_BEGIN

/// An entry of a vertex' row: a hinge as seen from the vertex, as it is folded now.
typedef struct {
    real3 bend, spin;
    real weight;
} curved_hinge_entry;

/// x  the vertex [m]; the tables as in gather_curved_hinges
WEFT_INLINE curved_hinge_entry load_curved_hinge_entry(WEFT_GLOBAL const float4* positions,
                                                       WEFT_GLOBAL const int* others,
                                                       WEFT_GLOBAL const float* weights, real3 x,
                                                       item entry, int entry_count) {
    const item second = column(entry, entry_count, 1);
    const item third = column(entry, entry_count, 2);
    const real3 y1 = subtract(xyz(gather4(positions, load_index(others, entry))), x);
    const real3 y2 = subtract(xyz(gather4(positions, load_index(others, second))), x);
    const real3 y3 = subtract(xyz(gather4(positions, load_index(others, third))), x);
    const curved_hinge h = load_curved_hinge(weights, entry, entry_count);
    curved_hinge_entry e = {curved_hinge_bend(h, y1, y2, y3), curved_hinge_spin(h, y1, y2, y3),
                            curved_hinge_weight(h)};
    return e;
}

/// Adds the hinges that are folded at rest to each vertex' derivatives. Parameters as in
/// gather_springs, and
/// others   [3 * entries] column-major: the hinge's other vertices
/// weights  [6 * entries] column-major: their weights and those of their pairs, see
///          energies/curved_hinge.h
WEFT_KERNEL(gather_curved_hinges, WEFT_GLOBAL const float4* positions,
            WEFT_GLOBAL const int* vertices, WEFT_GLOBAL const int* slices,
            WEFT_GLOBAL const int* others, WEFT_GLOBAL const float* weights,
            WEFT_GLOBAL float* sums, int item_count, int entry_count, int stride, int fresh) {
    derivatives s = fresh ? zero_derivatives() : load_derivatives(sums, i, item_count);
    const real3 x = xyz(gather4(positions, load_index(vertices, i)));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const curved_hinge_entry e = load_curved_hinge_entry(
            positions, others, weights, x, row_entry(slices, i, stride, k), entry_count);
        s.gradient = add(s.gradient, curved_hinge_gradient(e.bend, e.weight, e.spin));
        s.hessian = add_sym(s.hessian, curved_hinge_hessian(e.weight, e.spin));
    }
    store_derivatives(sums, i, item_count, s);
}

/// Only the gradients: the Hessian columns of the sums are left as they are.
WEFT_KERNEL(gather_curved_hinge_gradients, WEFT_GLOBAL const float4* positions,
            WEFT_GLOBAL const int* vertices, WEFT_GLOBAL const int* slices,
            WEFT_GLOBAL const int* others, WEFT_GLOBAL const float* weights,
            WEFT_GLOBAL float* sums, int item_count, int entry_count, int stride, int fresh) {
    real3 gradient = make3(splat(0.0f), splat(0.0f), splat(0.0f));
    if (!fresh) gradient = load_gradient(sums, i, item_count);
    const real3 x = xyz(gather4(positions, load_index(vertices, i)));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const curved_hinge_entry e = load_curved_hinge_entry(
            positions, others, weights, x, row_entry(slices, i, stride, k), entry_count);
        gradient = add(gradient, curved_hinge_gradient(e.bend, e.weight, e.spin));
    }
    store_gradient(sums, i, item_count, gradient);
}

/// corners, weights as in project_curved_hinges; the others as in spring_terms
WEFT_KERNEL(curved_hinge_terms, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* weights, WEFT_GLOBAL const int* slots,
            WEFT_GLOBAL float* terms, int hinge_count) {
    const real3 x0 = xyz(gather4(positions, load_index(corners, i)));
    const real3 x1 = xyz(gather4(positions, load_index(corners, column(i, hinge_count, 1))));
    const real3 x2 = xyz(gather4(positions, load_index(corners, column(i, hinge_count, 2))));
    const real3 x3 = xyz(gather4(positions, load_index(corners, column(i, hinge_count, 3))));
    const real3 bend = curved_hinge_bend(load_curved_hinge(weights, i, hinge_count),
                                         subtract(x1, x0), subtract(x2, x0), subtract(x3, x0));
    store_term(terms, slots, i, splat(0.5f) * dot3(bend, bend));
}

WEFT_KERNELS_END

#endif
