#ifndef WEFT_KERNELS_NEWTON_BLOCKS_H
#define WEFT_KERNELS_NEWTON_BLOCKS_H

// The Hessian of all elements of a family, as blocks of two vertices. An energy does not see a
// translation, so each row of its Hessian adds up to 0, and with B_vw = -d2E/dx_vdx_w
//   (H p)_v = sum_w B_vw (p_v - p_w)
// Differences come first: what is the same everywhere vanishes without rounding.
//
// A block is one number where it is a multiple of I, six where it is symmetric, or nine:
// blocks  [columns * blocks] column-major: xx, xy, xz, yy, yz, zz, yx, zx, zy
//
// A block is the sum of what the elements contribute that have both vertices. Its contributions are
// a row (descent/rows.h), so the same kernels also sum the blocks of two groups of vertices, which
// the coarse space needs: then a row has the contributions of all pairs across.

#include "kernels/descent/rows.h"
#include "kernels/matrix.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

WEFT_INLINE mat3 zero_mat(void) {
    const real3 zero = make3(splat(0.0f), splat(0.0f), splat(0.0f));
    return make_mat(zero, zero, zero);
}

WEFT_INLINE mat3 scale_mat(mat3 a, real s) {
    return make_mat(scale(a.x, s), scale(a.y, s), scale(a.z, s));
}

WEFT_INLINE mat3 mat_of_sym(sym3 a) {
    return make_mat(make3(a.xx, a.xy, a.xz), make3(a.xy, a.yy, a.yz), make3(a.xz, a.yz, a.zz));
}

WEFT_INLINE void put(WEFT_GLOBAL float* blocks, item place, real value, int fresh) {
    store(blocks, place, fresh ? value : load(blocks, place) + value);
}

/// Adds to a block, or overwrites it where `fresh` is 1; of a symmetric one, a.x and what of a.y
/// and a.z is not in it already.
WEFT_INLINE void put_block(WEFT_GLOBAL float* blocks, item i, int count, int columns, mat3 a,
                           int fresh) {
    put(blocks, i, a.x.x, fresh);
    if (columns < 6) return;
    put(blocks, column(i, count, 1), a.y.x, fresh);
    put(blocks, column(i, count, 2), a.z.x, fresh);
    put(blocks, column(i, count, 3), a.y.y, fresh);
    put(blocks, column(i, count, 4), a.z.y, fresh);
    put(blocks, column(i, count, 5), a.z.z, fresh);
    if (columns < 9) return;
    put(blocks, column(i, count, 6), a.x.y, fresh);
    put(blocks, column(i, count, 7), a.x.z, fresh);
    put(blocks, column(i, count, 8), a.y.z, fresh);
}

WEFT_INLINE sym3 load_symmetric_block(WEFT_GLOBAL const float* blocks, item i, int count) {
    return make_sym(load(blocks, i), load(blocks, column(i, count, 1)),
                    load(blocks, column(i, count, 2)), load(blocks, column(i, count, 3)),
                    load(blocks, column(i, count, 4)), load(blocks, column(i, count, 5)));
}

WEFT_INLINE mat3 load_block(WEFT_GLOBAL const float* blocks, item i, int count) {
    const real xy = load(blocks, column(i, count, 1));
    const real xz = load(blocks, column(i, count, 2));
    const real yz = load(blocks, column(i, count, 4));
    return make_mat(make3(load(blocks, i), load(blocks, column(i, count, 6)),
                          load(blocks, column(i, count, 7))),
                    make3(xy, load(blocks, column(i, count, 3)), load(blocks, column(i, count, 8))),
                    make3(xz, yz, load(blocks, column(i, count, 5))));
}

/// Blocks out of what elements have given, each once for all blocks that it is part of.
/// slices          [2 * blocks] see rows.h
/// element_blocks  three float4 each: d2E/dx_jdx_k [N/m], column by column
/// places          [entries] in element_blocks; what fills a row up has a place of zeros
/// turned          [entries] 1: the block is wanted the other way round, of x_k and x_j; or 0
/// blocks          [columns * blocks] as above
/// stride          between the entries of one row
WEFT_KERNEL(sum_element_blocks, WEFT_GLOBAL const int* slices,
            WEFT_GLOBAL const float4* element_blocks, WEFT_GLOBAL const int* places,
            WEFT_GLOBAL const float* turned, WEFT_GLOBAL float* blocks, int block_count,
            int columns, int stride, int fresh) {
    mat3 sum = zero_mat();
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const integer place = load_index(places, entry);
        const real3 x = xyz(gather4(element_blocks, place));
        const real3 y = xyz(gather4(element_blocks + 1, place));
        const real3 z = xyz(gather4(element_blocks + 2, place));
        const real turn = load(turned, entry);
        const real zero = splat(0.0f);
        sum = add_mat(sum, make_mat(make3(x.x, turn > zero ? y.x : x.y, turn > zero ? z.x : x.z),
                                    make3(turn > zero ? x.y : y.x, y.y, turn > zero ? z.y : y.z),
                                    make3(turn > zero ? x.z : z.x, turn > zero ? y.z : z.y, z.z)));
    }
    put_block(blocks, i, block_count, columns, scale_mat(sum, splat(-1.0f)), fresh);
}

/// The blocks of the vertices themselves: each is the sum of its row.
/// slices  [2 * vertices] see rows.h
/// blocks  [columns * entries]
/// sums    [9 * vertices] see rows.h; the Hessian's columns are added to, or overwritten where
///         `fresh` is 1
/// stride  between the entries of one row
WEFT_KERNEL(sum_block_rows, WEFT_GLOBAL const int* slices, WEFT_GLOBAL const float* blocks,
            WEFT_GLOBAL float* sums, int vertex_count, int entry_count, int columns, int stride,
            int fresh) {
    sym3 sum = diagonal_sym(splat(0.0f));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        if (columns == 1) {
            sum = add_diagonal(sum, load(blocks, entry));
        } else {
            sum = add_sym(sum, load_symmetric_block(blocks, entry, entry_count));
        }
    }
    put(sums, column(i, vertex_count, 3), sum.xx, fresh);
    put(sums, column(i, vertex_count, 4), sum.xy, fresh);
    put(sums, column(i, vertex_count, 5), sum.xz, fresh);
    put(sums, column(i, vertex_count, 6), sum.yy, fresh);
    put(sums, column(i, vertex_count, 7), sum.yz, fresh);
    put(sums, column(i, vertex_count, 8), sum.zz, fresh);
}

WEFT_INLINE real3 load_product(WEFT_GLOBAL const float* products, item i, int count, int fresh) {
    const real zero = splat(0.0f);
    if (fresh) return make3(zero, zero, zero);
    return make3(load(products, i), load(products, column(i, count, 1)),
                 load(products, column(i, count, 2)));
}

WEFT_INLINE void store_product(WEFT_GLOBAL float* products, item i, int count, real3 sum) {
    store(products, i, sum.x);
    store(products, column(i, count, 1), sum.y);
    store(products, column(i, count, 2), sum.z);
}

/// products += H p of one family, whose blocks are multiples of I.
/// directions  [vertices] xyz: p
/// slices      [2 * vertices] see rows.h
/// others      [entries] w; a row is filled up with the vertex itself
/// blocks      [entries] of each entry
/// products    [3 * vertices] column-major; added to, or overwritten where `fresh` is 1
/// stride      between the entries of one row
WEFT_KERNEL(multiply_scalar_blocks, WEFT_GLOBAL const float4* directions,
            WEFT_GLOBAL const int* slices, WEFT_GLOBAL const int* others,
            WEFT_GLOBAL const float* blocks, WEFT_GLOBAL float* products, int vertex_count,
            int stride, int fresh) {
    real3 sum = load_product(products, i, vertex_count, fresh);
    const real3 own = xyz(load4(directions, i));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const real3 other = xyz(gather4(directions, load_index(others, entry)));
        sum = add_scaled(sum, subtract(own, other), load(blocks, entry));
    }
    store_product(products, i, vertex_count, sum);
}

/// The same with symmetric blocks [6 * entries].
WEFT_KERNEL(multiply_symmetric_blocks, WEFT_GLOBAL const float4* directions,
            WEFT_GLOBAL const int* slices, WEFT_GLOBAL const int* others,
            WEFT_GLOBAL const float* blocks, WEFT_GLOBAL float* products, int vertex_count,
            int entry_count, int stride, int fresh) {
    real3 sum = load_product(products, i, vertex_count, fresh);
    const real3 own = xyz(load4(directions, i));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const real3 other = xyz(gather4(directions, load_index(others, entry)));
        sum = add(sum, multiply_sym(load_symmetric_block(blocks, entry, entry_count),
                                    subtract(own, other)));
    }
    store_product(products, i, vertex_count, sum);
}

/// The same with any blocks [9 * entries].
WEFT_KERNEL(multiply_blocks, WEFT_GLOBAL const float4* directions, WEFT_GLOBAL const int* slices,
            WEFT_GLOBAL const int* others, WEFT_GLOBAL const float* blocks,
            WEFT_GLOBAL float* products, int vertex_count, int entry_count, int stride, int fresh) {
    real3 sum = load_product(products, i, vertex_count, fresh);
    const real3 own = xyz(load4(directions, i));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const real3 other = xyz(gather4(directions, load_index(others, entry)));
        sum = add(sum, multiply_mat(load_block(blocks, entry, entry_count), subtract(own, other)));
    }
    store_product(products, i, vertex_count, sum);
}

WEFT_KERNELS_END

#endif
