#ifndef WEFT_KERNELS_CONTACT_OVERLAP_H
#define WEFT_KERNELS_CONTACT_OVERLAP_H

// Boxes against boxes: one box against those of all items at hand, first together, then one by one.

#include "kernels/contact/boxes.h"
#include "kernels/lanes.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

typedef struct {
    float low_x, low_y, low_z, high_x, high_y, high_z;
} float_box;

/// Around the boxes of all items at hand.
WEFT_INLINE float_box around_all(real_box box) {
    float_box all;
    all.low_x = smallest_real(box.low.x);
    all.low_y = smallest_real(box.low.y);
    all.low_z = smallest_real(box.low.z);
    all.high_x = largest_real(box.high.x);
    all.high_y = largest_real(box.high.y);
    all.high_z = largest_real(box.high.z);
    return all;
}

WEFT_INLINE int meets(float_box a, float4 low, float4 high) {
    return a.low_x <= high.x && a.high_x >= low.x && a.low_y <= high.y && a.high_y >= low.y &&
           a.low_z <= high.z && a.high_z >= low.z;
}

WEFT_INLINE mask overlaps(real_box a, float4 low, float4 high) {
    const mask x = both(a.low.x <= splat(high.x), a.high.x >= splat(low.x));
    const mask y = both(a.low.y <= splat(high.y), a.high.y >= splat(low.y));
    const mask z = both(a.low.z <= splat(high.z), a.high.z >= splat(low.z));
    return both(x, both(y, z));
}

/// One box each.
WEFT_INLINE mask overlap(real_box a, real_box b) {
    const mask x = both(a.low.x <= b.high.x, a.high.x >= b.low.x);
    const mask y = both(a.low.y <= b.high.y, a.high.y >= b.low.y);
    const mask z = both(a.low.z <= b.high.z, a.high.z >= b.low.z);
    return both(x, both(y, z));
}

/// How far apart two boxes are along the axis that tells most; negative where they overlap.
WEFT_INLINE real box_distance(real_box a, real_box b) {
    const real x = larger(b.low.x - a.high.x, a.low.x - b.high.x);
    const real y = larger(b.low.y - a.high.y, a.low.y - b.high.y);
    const real z = larger(b.low.z - a.high.z, a.low.z - b.high.z);
    return larger(x, larger(y, z));
}

/// Lower by so much, and by more than what coordinates are rounded by.
WEFT_INLINE real lowered(real x, real by) { return x - (by + splat(1e-6f) * larger(x, -x)); }

/// Larger on all sides.
WEFT_INLINE real_box widened(real_box box, real by) {
    box.low = make3(lowered(box.low.x, by), lowered(box.low.y, by), lowered(box.low.z, by));
    box.high =
        make3(-lowered(-box.high.x, by), -lowered(-box.high.y, by), -lowered(-box.high.z, by));
    return box;
}

/// What bounds a patch: its box, and its sums and differences.
typedef struct {
    real_box box, sums, differences;
} real_bounds;

WEFT_INLINE real_box gather_box(WEFT_GLOBAL const float4* low, WEFT_GLOBAL const float4* high,
                                whole patch) {
    real_box box;
    box.low = xyz(gather4(low, address(patch)));
    box.high = xyz(gather4(high, address(patch)));
    return box;
}

/// Those of a patch each, as enclose_patches leaves them.
WEFT_INLINE real_bounds gather_bounds(WEFT_GLOBAL const float4* low, WEFT_GLOBAL const float4* high,
                                      WEFT_GLOBAL const float4* slant_low,
                                      WEFT_GLOBAL const float4* slant_high, whole patch,
                                      int patch_count) {
    const whole second = patch + splat_whole(patch_count);
    real_bounds bounds = {gather_box(low, high, patch), gather_box(slant_low, slant_high, patch),
                          gather_box(slant_low, slant_high, second)};
    return bounds;
}

WEFT_INLINE real_bounds widened_bounds(real_bounds bounds, real by) {
    const real slant = splat(WEFT_SLANT) * by;
    bounds.box = widened(bounds.box, by);
    bounds.sums = widened(bounds.sums, slant);
    bounds.differences = widened(bounds.differences, slant);
    return bounds;
}

WEFT_INLINE mask bounds_overlap(real_bounds a, real_bounds b) {
    return both(overlap(a.box, b.box),
                both(overlap(a.sums, b.sums), overlap(a.differences, b.differences)));
}

/// Where the rows of the items at hand lie, and how long they are by now.
typedef struct {
    whole start, room, count;
} open_rows;

WEFT_INLINE open_rows open_rows_of(WEFT_GLOBAL const int* rows, item i, int item_count) {
    open_rows row = {load_whole(rows, i), load_whole(rows, column(i, item_count, 1)),
                     splat_whole(0)};
    return row;
}

/// Another entry in the rows that `on` holds for, where there is room.
WEFT_INLINE open_rows with_entry(open_rows row, mask on, WEFT_GLOBAL int* others, whole entry) {
    const integer place = address(row.start + row.count * splat_whole(WEFT_ROW_STRIDE));
    scatter_whole_where(both(on, row.count < row.room), others, place, entry);
    row.count = on ? row.count + splat_whole(1) : row.count;
    return row;
}

/// counts  [items] written: entries that each row has
/// needs   [items] the most that a row should have had room for since instance 0
WEFT_INLINE void close_rows(open_rows row, WEFT_GLOBAL int* counts, WEFT_GLOBAL int* needs, item i,
                            int instance) {
    store_whole(counts, i, smaller_whole(row.count, row.room));
    store_whole(needs, i,
                instance == 0 ? row.count : larger_whole(row.count, load_whole(needs, i)));
}

WEFT_KERNELS_END

#endif
