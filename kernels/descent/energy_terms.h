#ifndef WEFT_KERNELS_DESCENT_ENERGY_TERMS_H
#define WEFT_KERNELS_DESCENT_ENERGY_TERMS_H

// E(x) as a sum that every device adds up in the same order: each element writes its term, 64
// columns of each strip's terms are added up, and what these give is left to whoever wants it. No
// term is negative (but of solids with a negative Poisson's ratio), so rounding is relative to E.
//
// slots  [items] where in `terms` an item's stands; items of one strip stand side by side

#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

WEFT_INLINE void store_term(WEFT_GLOBAL float* terms, WEFT_GLOBAL const int* slots, item i,
                            real term) {
    const item place = {slots[i.first], i.count};
    store(terms, place, term);
}

/// m / (2 h^2) |x - x~|^2 of free vertices; inverse_h2 = 1 / h^2
WEFT_KERNEL(inertia_terms, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float4* targets,
            WEFT_GLOBAL const int* slots, WEFT_GLOBAL float* terms, float inverse_h2) {
    const real4 x = load4(positions, i);
    const real3 away = subtract(xyz(x), xyz(load4(targets, i)));
    const real inertia = inverse_h2 / (x.w > splat(0.0f) ? x.w : splat(1.0f));
    const real free = x.w > splat(0.0f) ? splat(0.5f) : splat(0.0f);
    store_term(terms, slots, i, free * inertia * dot3(away, away));
}

/// Adds up columns: sums[i] = terms[begin] + terms[begin + stride] + ..., `length` terms.
/// columns  [2 * items] begin, length; those of neighbouring items are neighbours
WEFT_KERNEL(add_terms, WEFT_GLOBAL const float* terms, WEFT_GLOBAL const int* columns,
            WEFT_GLOBAL float* sums, int stride) {
    real sum = splat(0.0f);
    const int length = columns[2 * i.first + 1];
    for (int k = 0; k < length; ++k) {
        const item place = {columns[2 * i.first] + stride * k, i.count};
        sum = sum + load(terms, place);
    }
    store(sums, i, sum);
}

WEFT_KERNELS_END

#endif
