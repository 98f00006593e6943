#ifndef WEFT_KERNELS_DESCENT_SPRINGS_H
#define WEFT_KERNELS_DESCENT_SPRINGS_H

#include "kernels/descent/energy_terms.h"
#include "kernels/descent/rows.h"
#include "kernels/energies/spring.h"

WEFT_KERNELS_BEGIN

/// Adds the springs' part of each vertex' gradient and Hessian block.
/// positions    [vertices] xyz [m]
/// vertices     [items] the vertex of each item
/// slices       [2 * items] see rows.h
/// others       [entries] the vertex at the other end
/// material     [2 * entries] column-major: rest length [m], stiffness [N/m]
/// sums         [9 * items] added to, or overwritten where `fresh` is 1
/// stride       between the entries of one row
WEFT_KERNEL(gather_springs, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* vertices,
            WEFT_GLOBAL const int* slices, WEFT_GLOBAL const int* others,
            WEFT_GLOBAL const float* material, WEFT_GLOBAL float* sums, int item_count,
            int entry_count, int stride, int fresh) {
    derivatives s = fresh ? zero_derivatives() : load_derivatives(sums, i, item_count);
    const real3 x = xyz(gather4(positions, load_index(vertices, i)));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const real3 other = xyz(gather4(positions, load_index(others, entry)));
        const real rest = load(material, entry);
        const real stiffness = load(material, column(entry, entry_count, 1));
        s.gradient = add(s.gradient, spring_gradient(x, other, rest, stiffness));
        s.hessian = add_sym(s.hessian, spring_hessian(x, other, rest, stiffness));
    }
    store_derivatives(sums, i, item_count, s);
}

/// Only the gradients. Parameters as in gather_springs.
WEFT_KERNEL(gather_spring_gradients, WEFT_GLOBAL const float4* positions,
            WEFT_GLOBAL const int* vertices, WEFT_GLOBAL const int* slices,
            WEFT_GLOBAL const int* others, WEFT_GLOBAL const float* material,
            WEFT_GLOBAL float* sums, int item_count, int entry_count, int stride, int fresh) {
    real3 gradient = make3(splat(0.0f), splat(0.0f), splat(0.0f));
    if (!fresh) gradient = load_gradient(sums, i, item_count);
    const real3 x = xyz(gather4(positions, load_index(vertices, i)));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const real3 other = xyz(gather4(positions, load_index(others, entry)));
        gradient = add(gradient, spring_gradient(x, other, load(material, entry),
                                                 load(material, column(entry, entry_count, 1))));
    }
    store_gradient(sums, i, item_count, gradient);
}

/// Each spring's energy. ends, material as in project_springs
WEFT_KERNEL(spring_terms, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* ends,
            WEFT_GLOBAL const float* material, WEFT_GLOBAL const int* slots,
            WEFT_GLOBAL float* terms, int spring_count) {
    const real3 x0 = xyz(gather4(positions, load_index(ends, i)));
    const real3 x1 = xyz(gather4(positions, load_index(ends, column(i, spring_count, 1))));
    const real stiffness = splat(1.0f) / load(material, column(i, spring_count, 1));
    store_term(terms, slots, i, spring_energy(x0, x1, load(material, i), stiffness));
}

WEFT_KERNELS_END

#endif
