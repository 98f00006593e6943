#ifndef WEFT_KERNELS_DESCENT_STITCHES_H
#define WEFT_KERNELS_DESCENT_STITCHES_H

#include "kernels/columns.h"
#include "kernels/descent/energy_terms.h"
#include "kernels/descent/rows.h"
#include "kernels/energies/stitch.h"

WEFT_KERNELS_BEGIN

/// Adds the stitches' part of each vertex' slope. Parameters as in gather_springs, and
/// material  [3 * entries] column-major: length at the start [m], stiffness [N/m], rate [1/s]
/// clock     [substeps] time at each substep's end [s]; instance: which substep
WEFT_KERNEL(gather_stitches, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* vertices,
            WEFT_GLOBAL const int* slices, WEFT_GLOBAL const int* others,
            WEFT_GLOBAL const float* material, WEFT_GLOBAL const float* clock,
            WEFT_GLOBAL float* sums, int item_count, int entry_count, int stride, int fresh,
            int instance) {
    derivatives s = fresh ? zero_derivatives() : load_derivatives(sums, i, item_count);
    const real3 x = xyz(gather4(positions, load_index(vertices, i)));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const real3 other = xyz(gather4(positions, load_index(others, entry)));
        const real rest = stitch_rest(
            load(material, entry), load(material, column(entry, entry_count, 2)), clock[instance]);
        const real stiffness = load(material, column(entry, entry_count, 1));
        s.gradient = add(s.gradient, spring_gradient(x, other, rest, stiffness));
        s.hessian = add_sym(s.hessian, spring_hessian(x, other, rest, stiffness));
    }
    store_derivatives(sums, i, item_count, s);
}

/// Only the gradients: the Hessian columns of the sums are left as they are.
WEFT_KERNEL(gather_stitch_gradients, WEFT_GLOBAL const float4* positions,
            WEFT_GLOBAL const int* vertices, WEFT_GLOBAL const int* slices,
            WEFT_GLOBAL const int* others, WEFT_GLOBAL const float* material,
            WEFT_GLOBAL const float* clock, WEFT_GLOBAL float* sums, int item_count,
            int entry_count, int stride, int fresh, int instance) {
    real3 gradient = make3(splat(0.0f), splat(0.0f), splat(0.0f));
    if (!fresh) gradient = load_gradient(sums, i, item_count);
    const real3 x = xyz(gather4(positions, load_index(vertices, i)));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const real3 other = xyz(gather4(positions, load_index(others, entry)));
        const real rest = stitch_rest(
            load(material, entry), load(material, column(entry, entry_count, 2)), clock[instance]);
        gradient = add(gradient, spring_gradient(x, other, rest,
                                                 load(material, column(entry, entry_count, 1))));
    }
    store_gradient(sums, i, item_count, gradient);
}

/// ends, material and clock as in project_stitches
WEFT_KERNEL(stitch_terms, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* ends,
            WEFT_GLOBAL const float* material, WEFT_GLOBAL const float* clock,
            WEFT_GLOBAL const int* slots, WEFT_GLOBAL float* terms, int count, int instance) {
    const real3 x0 = xyz(gather4(positions, load_index(ends, i)));
    const real3 x1 = xyz(gather4(positions, load_index(ends, column(i, count, 1))));
    const real rest =
        stitch_rest(load(material, i), load(material, column(i, count, 2)), clock[instance]);
    const real stiffness = splat(1.0f) / load(material, column(i, count, 1));
    store_term(terms, slots, i, spring_energy(x0, x1, rest, stiffness));
}

WEFT_KERNELS_END

#endif
