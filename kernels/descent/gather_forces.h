#ifndef WEFT_KERNELS_DESCENT_GATHER_FORCES_H
#define WEFT_KERNELS_DESCENT_GATHER_FORCES_H

// Gradients alone, for methods that do not want the Hessian blocks every time: like gather_springs
// and gather_bending, with the Hessian columns of the sums left as they are.

#include "kernels/descent/rows.h"
#include "kernels/energies/spring.h"

WEFT_KERNELS_BEGIN

WEFT_INLINE real3 load_gradient(WEFT_GLOBAL const float* sums, item i, int items) {
    return make3(load(sums, i), load(sums, column(i, items, 1)), load(sums, column(i, items, 2)));
}

WEFT_INLINE void store_gradient(WEFT_GLOBAL float* sums, item i, int items, real3 gradient) {
    store(sums, i, gradient.x);
    store(sums, column(i, items, 1), gradient.y);
    store(sums, column(i, items, 2), gradient.z);
}

/// Parameters as in gather_springs.
WEFT_KERNEL(gather_spring_forces, WEFT_GLOBAL const float4* positions,
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

/// Parameters as in gather_bending, without the diagonal.
WEFT_KERNEL(gather_bending_forces, WEFT_GLOBAL const float4* positions,
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

WEFT_KERNELS_END

#endif
