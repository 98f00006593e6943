#ifndef WEFT_KERNELS_DESCENT_GATHER_MEMBRANES_H
#define WEFT_KERNELS_DESCENT_GATHER_MEMBRANES_H

#include "kernels/descent/gather_forces.h"
#include "kernels/descent/rows.h"
#include "kernels/energies/membrane.h"

WEFT_KERNELS_BEGIN

/// An entry of a vertex' row.
typedef struct {
    membrane element;
    real2 own;  ///< b of the vertex [1/m]
} membrane_entry;

/// x  the vertex [m]; the tables as in gather_membranes
WEFT_INLINE membrane_entry load_membrane(WEFT_GLOBAL const float4* positions,
                                         WEFT_GLOBAL const int* others,
                                         WEFT_GLOBAL const float* shape,
                                         WEFT_GLOBAL const float* material, real3 x, item entry,
                                         int entry_count) {
    const real3 x1 = xyz(gather4(positions, load_index(others, entry)));
    const real3 x2 = xyz(gather4(positions, load_index(others, column(entry, entry_count, 1))));
    const real2 b1 = make2(load(shape, entry), load(shape, column(entry, entry_count, 1)));
    const real2 b2 = make2(load(shape, column(entry, entry_count, 2)),
                           load(shape, column(entry, entry_count, 3)));
    membrane_entry e;
    e.element = make_membrane(x, x1, x2, b1, b2, load(material, entry),
                              load(material, column(entry, entry_count, 1)));
    e.own = make2(-(b1.u + b2.u), -(b1.v + b2.v));
    return e;
}

/// Adds the membranes' part of each vertex' slope. Parameters as in gather_springs, and
/// others    [2 * entries] column-major: the triangle's other vertices
/// shape     [4 * entries] column-major: their b [1/m]; the vertex' own balances them
/// material  [2 * entries] column-major: mu, lambda, times the rest area [J]
WEFT_KERNEL(gather_membranes, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* vertices,
            WEFT_GLOBAL const int* slices, WEFT_GLOBAL const int* others,
            WEFT_GLOBAL const float* shape, WEFT_GLOBAL const float* material,
            WEFT_GLOBAL float* sums, int item_count, int entry_count, int stride, int fresh) {
    slope s = fresh ? no_slope() : load_slope(sums, i, item_count);
    const real3 x = xyz(gather4(positions, load_index(vertices, i)));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const membrane_entry e =
            load_membrane(positions, others, shape, material, x, entry, entry_count);
        s.gradient = add(s.gradient, membrane_gradient(e.element, e.own));
        s.hessian = add_sym(s.hessian, membrane_hessian(e.element, e.own));
    }
    store_slope(sums, i, item_count, s);
}

/// Only the gradients: the Hessian columns of the sums are left as they are.
WEFT_KERNEL(gather_membrane_forces, WEFT_GLOBAL const float4* positions,
            WEFT_GLOBAL const int* vertices, WEFT_GLOBAL const int* slices,
            WEFT_GLOBAL const int* others, WEFT_GLOBAL const float* shape,
            WEFT_GLOBAL const float* material, WEFT_GLOBAL float* sums, int item_count,
            int entry_count, int stride, int fresh) {
    real3 gradient = make3(splat(0.0f), splat(0.0f), splat(0.0f));
    if (!fresh) gradient = load_gradient(sums, i, item_count);
    const real3 x = xyz(gather4(positions, load_index(vertices, i)));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const membrane_entry e =
            load_membrane(positions, others, shape, material, x, entry, entry_count);
        gradient = add(gradient, membrane_gradient(e.element, e.own));
    }
    store_gradient(sums, i, item_count, gradient);
}

WEFT_KERNELS_END

#endif
