#ifndef WEFT_KERNELS_NEWTON_COARSE_H
#define WEFT_KERNELS_NEWTON_COARSE_H

// The coarse space: translations of aggregates, patches of vertices that lie in one strip. With T
// what spreads a vector per aggregate to its vertices, C = T^T (M / h^2 + H) T is small, and only
// aggregates of one strip or two neighbouring ones share an element: a band. It is factored by one
// item, its inverse is made column by column, and applied strip by strip: rows of a dense matrix.
//
// Unknown 3 a + c is component c of aggregate a; n = 3 * aggregates.

#include "kernels/columns.h"
#include "kernels/in_order.h"
#include "kernels/newton/blocks.h"

WEFT_KERNELS_BEGIN

/// T^T r. Items are aggregates.
/// rows        [2 * aggregates] first entry, number of rows (see bodies/runs.h)
/// members     [entries] vertices; a row is filled up with a vertex of any aggregate
/// shares      [entries] 1, or 0 where a row is filled up
/// restricted  [aggregates] written: xyz, w = 0
WEFT_KERNEL(restrict_residuals, WEFT_GLOBAL const float4* residuals, WEFT_GLOBAL const int* members,
            WEFT_GLOBAL const float* shares, WEFT_GLOBAL const int* rows,
            WEFT_GLOBAL float4* restricted, int stride) {
    real3 sum = make3(splat(0.0f), splat(0.0f), splat(0.0f));
    const int length = row_length(rows, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(rows, i, stride, k);
        sum = add_scaled(sum, xyz(gather4(residuals, load_index(members, entry))),
                         load(shares, entry));
    }
    store4(restricted, i, with_w(sum, splat(0.0f)));
}

/// C = L D L^T; only item 0 does so. Pivots that rounding made tiny are lifted: what comes out is
/// positive definite.
/// pairs   [2 * pairs] a, b with b < a; b = a: what of a is tied to vertices that are held
/// blocks  [9 * pairs] column-major, B_ab of blocks.h, summed over the vertices of both
/// inertia  [aggregates] mass / h^2 [N/m]
/// band    [n * (width + 1)] written: row r holds columns r - width to r - 1 of L, then 1 / D
WEFT_KERNEL(factor_coarse, WEFT_GLOBAL const int* pairs, WEFT_GLOBAL const float* blocks,
            WEFT_GLOBAL const float* inertia, WEFT_GLOBAL float* band, int pair_count,
            int aggregate_count, int width) {
    if (i.first > 0) return;
    const int n = 3 * aggregate_count;
    const int row = width + 1;
    for (int k = 0; k < n * row; ++k) band[k] = 0.0f;
    for (int k = 0; k < n; ++k) band[k * row + width] = inertia[k / 3];
    for (int pair = 0; pair < pair_count; ++pair) {
        const int a = 3 * pairs[2 * pair];
        const int b = 3 * pairs[2 * pair + 1];
        const int is_pair = b < a;
        float block[9];
        block[0] = blocks[pair];
        block[1] = blocks[pair + pair_count];
        block[2] = blocks[pair + 2 * pair_count];
        block[3] = blocks[pair + 6 * pair_count];
        block[4] = blocks[pair + 3 * pair_count];
        block[5] = blocks[pair + 4 * pair_count];
        block[6] = blocks[pair + 7 * pair_count];
        block[7] = blocks[pair + 8 * pair_count];
        block[8] = blocks[pair + 5 * pair_count];
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 3; ++c) {
                if (c <= r) {
                    // The two blocks on the diagonal are symmetric in sum only.
                    const float average = 0.5f * (block[3 * r + c] + block[3 * c + r]);
                    band[(a + r) * row + width + c - r] += average;
                    if (is_pair) band[(b + r) * row + width + c - r] += average;
                }
                if (is_pair) band[(a + r) * row + width + b + c - a - r] -= block[3 * r + c];
            }
        }
    }
    for (int r = 0; r < n; ++r) {
        const int first = r > width ? r - width : 0;
        WEFT_GLOBAL float* own = band + r * row + width - r;  // own[c]: column c of row r
        const float least = 1e-5f * own[r];
        for (int c = first; c < r; ++c) {
            WEFT_GLOBAL const float* other = band + c * row + width - c;
            float value = own[c];
            const int common = c > width ? (first > c - width ? first : c - width) : first;
            WEFT_IN_ORDER
            for (int k = common; k < c; ++k) value -= own[k] * other[k];
            own[c] = value;  // L D so far
        }
        float pivot = own[r];
        WEFT_IN_ORDER
        for (int c = first; c < r; ++c) {
            const float scaled = own[c] * band[c * row + width];
            pivot -= own[c] * scaled;
            own[c] = scaled;
        }
        pivot = pivot > least ? pivot : least;
        own[r] = 1.0f / (pivot > 1e-30f ? pivot : 1e-30f);
    }
}

/// The columns of C^-1 that belong to an aggregate. Items are aggregates.
/// numbers  [aggregates] 0, 1, 2 ...
/// places   [aggregates] where in `inverse` an aggregate's numbers begin; neighbours of one strip
///          are neighbours, and the next number stands `columns` further
/// inverse  [3 * n * aggregates] written: entry j, c of an aggregate is the element of row j in the
///          column of its component c
WEFT_KERNEL(invert_coarse, WEFT_GLOBAL const float* band, WEFT_GLOBAL const float* numbers,
            WEFT_GLOBAL const int* places, WEFT_GLOBAL float* inverse, int aggregate_count,
            int width, int columns) {
    const int n = 3 * aggregate_count;
    const int row = width + 1;
    const real own = load(numbers, i);
    for (int c = 0; c < 3; ++c) {
        const int base = places[i.first] + c * columns;
        for (int r = 0; r < n; ++r) {
            const real is_own = own == splat((float)(r / 3)) ? splat(1.0f) : splat(0.0f);
            real value = r % 3 == c ? is_own : splat(0.0f);
            const int first = r > width ? r - width : 0;
            WEFT_GLOBAL const float* l = band + r * row + width - r;
            for (int k = first; k < r; ++k) {
                const item known = {base + 3 * columns * k, i.count};
                value = value - splat(l[k]) * load(inverse, known);
            }
            const item place = {base + 3 * columns * r, i.count};
            store(inverse, place, value);
        }
        for (int r = n - 1; r >= 0; --r) {
            const item place = {base + 3 * columns * r, i.count};
            real value = load(inverse, place) * splat(band[r * row + width]);
            const int last = r + width < n - 1 ? r + width : n - 1;
            for (int k = r + 1; k <= last; ++k) {
                const item known = {base + 3 * columns * k, i.count};
                value = value - splat(band[k * row + width + r - k]) * load(inverse, known);
            }
            store(inverse, place, value);
        }
    }
}

/// corrections = C^-1 restricted. Items are aggregates.
/// places, inverse, columns  as in invert_coarse
/// corrections               [aggregates + 1] written: xyz, w = 0
WEFT_KERNEL(correct_coarse, WEFT_GLOBAL const float4* restricted, WEFT_GLOBAL const float* inverse,
            WEFT_GLOBAL const int* places, WEFT_GLOBAL float4* corrections, int aggregate_count,
            int columns) {
    real3 sum = make3(splat(0.0f), splat(0.0f), splat(0.0f));
    for (int b = 0; b < aggregate_count; ++b) {
        const float4 r = restricted[b];
        const int base = places[i.first] + 9 * columns * b;
        const item x = {base, i.count};
        const item y = {base + 3 * columns, i.count};
        const item z = {base + 6 * columns, i.count};
        sum = add_scaled(sum, load3(inverse, x, columns, 0), splat(r.x));
        sum = add_scaled(sum, load3(inverse, y, columns, 0), splat(r.y));
        sum = add_scaled(sum, load3(inverse, z, columns, 0), splat(r.z));
    }
    store4(corrections, i, with_w(sum, splat(0.0f)));
}

WEFT_KERNELS_END

#endif
