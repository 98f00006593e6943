#ifndef WEFT_KERNELS_DESCENT_ROWS_H
#define WEFT_KERNELS_DESCENT_ROWS_H

// What descent methods read and write per vertex: the elements that touch it, and the sums of their
// gradients and Hessian blocks.
//
// Items are vertices in an order of the solver's own. The elements of an item are its row. Rows lie
// in slices of 16 items (SELL-C, Kreutzer et al. 2014): entry k of an item stands at start + stride
// k, and the items of a pack are neighbours in memory. All rows of a pack are as long as its
// longest one; short ones end with entries that contribute nothing.

#include "kernels/lanes.h"
#include "kernels/matrix.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// slices [2 * items] start of the item's row, length of the rows of 8 items that begin with it
WEFT_INLINE int row_length(WEFT_GLOBAL const int* slices, item i) {
    const int length = slices[2 * i.first + 1];
    if (i.count <= 8) return length;
    const int others = slices[2 * (i.first + 8) + 1];
    return length > others ? length : others;
}

/// Where the k-th entries of the items' rows are.
WEFT_INLINE item row_entry(WEFT_GLOBAL const int* slices, item i, int stride, int k) {
    item entry = {slices[2 * i.first] + stride * k, i.count};
    return entry;
}

/// dE/dx [N] and d2E/dx^2 [N/m] of one vertex
typedef struct {
    real3 gradient;
    sym3 hessian;
} derivatives;

WEFT_INLINE derivatives zero_derivatives(void) {
    const real zero = splat(0.0f);
    derivatives s = {make3(zero, zero, zero), diagonal_sym(zero)};
    return s;
}

/// sums [9 * items] column-major: gradient x, y, z, Hessian xx, xy, xz, yy, yz, zz
WEFT_INLINE derivatives load_derivatives(WEFT_GLOBAL const float* sums, item i, int items) {
    derivatives s;
    s.gradient =
        make3(load(sums, i), load(sums, column(i, items, 1)), load(sums, column(i, items, 2)));
    s.hessian = make_sym(load(sums, column(i, items, 3)), load(sums, column(i, items, 4)),
                         load(sums, column(i, items, 5)), load(sums, column(i, items, 6)),
                         load(sums, column(i, items, 7)), load(sums, column(i, items, 8)));
    return s;
}

WEFT_INLINE void store_derivatives(WEFT_GLOBAL float* sums, item i, int items, derivatives s) {
    store(sums, i, s.gradient.x);
    store(sums, column(i, items, 1), s.gradient.y);
    store(sums, column(i, items, 2), s.gradient.z);
    store(sums, column(i, items, 3), s.hessian.xx);
    store(sums, column(i, items, 4), s.hessian.xy);
    store(sums, column(i, items, 5), s.hessian.xz);
    store(sums, column(i, items, 6), s.hessian.yy);
    store(sums, column(i, items, 7), s.hessian.yz);
    store(sums, column(i, items, 8), s.hessian.zz);
}

// Gradients alone, for methods that do not want the Hessian blocks every time: the Hessian columns
// of the sums are left as they are.

WEFT_INLINE real3 load_gradient(WEFT_GLOBAL const float* sums, item i, int items) {
    return make3(load(sums, i), load(sums, column(i, items, 1)), load(sums, column(i, items, 2)));
}

/// Of any vertex, where items are vertices.
WEFT_INLINE real3 gather_gradient(WEFT_GLOBAL const float* sums, integer vertex, int items) {
    return make3(gather(sums, vertex), gather(sums + items, vertex),
                 gather(sums + 2 * items, vertex));
}

WEFT_INLINE void store_gradient(WEFT_GLOBAL float* sums, item i, int items, real3 gradient) {
    store(sums, i, gradient.x);
    store(sums, column(i, items, 1), gradient.y);
    store(sums, column(i, items, 2), gradient.z);
}

WEFT_KERNELS_END

#endif
