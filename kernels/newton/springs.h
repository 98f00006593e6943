#ifndef WEFT_KERNELS_NEWTON_SPRINGS_H
#define WEFT_KERNELS_NEWTON_SPRINGS_H

#include "kernels/energies/stitch.h"
#include "kernels/newton/blocks.h"

WEFT_KERNELS_BEGIN

/// Across a spring, its tension over its length holds it. Here this is the tension that the last
/// step was meant to leave, by the linear model that it was solved for: what the step has really
/// left also has the stretch that comes of turning, which sweeps take away again, but which would
/// stiffen the next matrix beyond use.
/// x, y            the ends [m]
/// before, after   from end to end, where the last step started, and where it led to [m]
WEFT_INLINE sym3 spring_block(real3 x, real3 y, real3 before, real3 after, real rest, real k) {
    const real zero = splat(0.0f);
    const real3 along = subtract(x, y);
    const real inverse = splat(1.0f) / divisor(length3(along));
    const real length = length3(before);
    const real3 direction = scale(before, splat(1.0f) / divisor(length));
    const real stretch = length - rest + dot3(direction, subtract(after, before));
    const real across = k * smaller(larger(stretch, zero) * inverse, splat(1.0f));
    return spring_stiffness(scale(along, inverse), k, across);
}

/// From end to end of the springs in a row.
WEFT_INLINE real3 along_springs(WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* corners,
                                item entry, int entry_count) {
    return subtract(xyz(gather4(positions, load_index(corners, entry))),
                    xyz(gather4(positions, load_index(corners, column(entry, entry_count, 1)))));
}

/// The springs' blocks. Items are blocks, a row has the springs between its two vertices, or
/// between its two groups of them.
/// positions    [vertices] xyz [m]
/// before, after  [vertices] xyz: see spring_block
/// slices       [2 * blocks] see rows.h
/// corners      [2 * entries] column-major: v and w
/// material     [2 * entries] column-major: rest length [m], stiffness [N/m]; 0 where a row is
///              filled up
/// blocks       see blocks.h; added to, or overwritten where `fresh` is 1
/// stride       between the entries of one row
WEFT_KERNEL(couple_springs, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float4* before,
            WEFT_GLOBAL const float4* after, WEFT_GLOBAL const int* slices,
            WEFT_GLOBAL const int* corners, WEFT_GLOBAL const float* material,
            WEFT_GLOBAL float* blocks, int block_count, int entry_count, int columns, int stride,
            int fresh) {
    sym3 sum = diagonal_sym(splat(0.0f));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const real3 x = xyz(gather4(positions, load_index(corners, entry)));
        const real3 y = xyz(gather4(positions, load_index(corners, column(entry, entry_count, 1))));
        sum = add_sym(sum, spring_block(x, y, along_springs(before, corners, entry, entry_count),
                                        along_springs(after, corners, entry, entry_count),
                                        load(material, entry),
                                        load(material, column(entry, entry_count, 1))));
    }
    put_block(blocks, i, block_count, columns, mat_of_sym(sum), fresh);
}

/// Parameters as in couple_springs, and
/// material  [3 * entries] column-major: length at the start [m], stiffness [N/m], rate [1/s]
/// clock     [substeps] time at each substep's end [s]; instance: which substep
WEFT_KERNEL(couple_stitches, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* slices,
            WEFT_GLOBAL const int* corners, WEFT_GLOBAL const float* material,
            WEFT_GLOBAL const float* clock, WEFT_GLOBAL float* blocks, int block_count,
            int entry_count, int columns, int stride, int fresh, int instance) {
    sym3 sum = diagonal_sym(splat(0.0f));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const real3 x = xyz(gather4(positions, load_index(corners, entry)));
        const real3 y = xyz(gather4(positions, load_index(corners, column(entry, entry_count, 1))));
        const real rest = stitch_rest(
            load(material, entry), load(material, column(entry, entry_count, 2)), clock[instance]);
        sum =
            add_sym(sum, spring_hessian(x, y, rest, load(material, column(entry, entry_count, 1))));
    }
    put_block(blocks, i, block_count, columns, mat_of_sym(sum), fresh);
}

WEFT_KERNELS_END

#endif
