#ifndef WEFT_KERNELS_CONTACT_NEAR_H
#define WEFT_KERNELS_CONTACT_NEAR_H

#include "kernels/contact/overlap.h"

WEFT_KERNELS_BEGIN

/// Where bounds overlap those of one other, as gather_bounds finds them.
WEFT_INLINE mask overlap_bounds(real_bounds own, WEFT_GLOBAL const float4* low,
                                WEFT_GLOBAL const float4* high, WEFT_GLOBAL const float4* slant_low,
                                WEFT_GLOBAL const float4* slant_high, int other, int count) {
    const mask on = overlaps(own.box, low[other], high[other]);
    if (!any_item(on)) return on;
    const mask sums = overlaps(own.sums, slant_low[other], slant_high[other]);
    const mask differences =
        overlaps(own.differences, slant_low[count + other], slant_high[count + other]);
    return both(on, both(sums, differences));
}

WEFT_INLINE real4 splat4(float4 p) {
    real4 v = {splat(p.x), splat(p.y), splat(p.z), splat(p.w)};
    return v;
}

/// Which way a patch faces, and where its inertia leads it.
typedef struct {
    real4 tilt, drift;
} real_leaning;

/// 1 where two flat patches face one way, and are quiet together: each by itself, or as they drift
/// alike. Else 0.
WEFT_INLINE whole are_smooth(real_leaning a, real_leaning b) {
    const whole none = splat_whole(0);
    const whole yes = splat_whole(1);
    const real each = a.tilt.w * b.tilt.w;
    const real3 apart = subtract(xyz(a.drift), xyz(b.drift));
    const real most = smaller(a.drift.w, b.drift.w);
    const whole alike = dot3(apart, apart) < most * most ? yes : none;
    const whole quiet = each > splat(1.0f) ? alike : yes;
    const mask flat = both(dot3(xyz(a.tilt), xyz(b.tilt)) >= splat(0.5f), each > splat(0.0f));
    return flat ? quiet : none;
}

/// 1 where the patch between two smooth ones lies as they do, and goes as they do; or is one of
/// them.
/// via        the patch between
/// first, second   the two
WEFT_INLINE whole is_smooth_by(WEFT_GLOBAL const float4* tilts, WEFT_GLOBAL const float4* drifts,
                               whole via, whole first, whole second, real_leaning a,
                               real_leaning b) {
    const mask is_third = both(via != first, via != second);
    if (!any_item(is_third)) return splat_whole(1);
    const integer patch = address(via);
    const real_leaning between = {gather4(tilts, patch), gather4(drifts, patch)};
    return is_third ? are_smooth(between, a) * are_smooth(between, b) : splat_whole(1);
}

/// Where two groups of patches are flat and quiet, and face the same way within 30 degrees.
WEFT_INLINE mask are_aligned(real4 a, real4 b) {
    const real zero = splat(0.0f);
    return both(both(a.w > zero, b.w > zero), dot3(xyz(a), xyz(b)) >= splat(0.8660f));
}

/// What a group hangs together with, gone through in ascending order.
typedef struct {
    whole group;
    real4 tilt;
    whole cursor, beside;  ///< where in the list; the group there
    whole folds;           ///< 1 where it has to be looked at with the group asked for, else 0
} sheet_walk;

/// tilts   as tilt_groups leaves them
/// begin, besides   of groups, as of patches in find_near_patches
WEFT_INLINE sheet_walk begin_walk(WEFT_GLOBAL const float4* tilts, WEFT_GLOBAL const int* begin,
                                  WEFT_GLOBAL const int* besides, whole group) {
    const whole cursor = gather_whole(begin, address(group));
    sheet_walk walk = {group, gather4(tilts, address(group)), cursor,
                       gather_whole(besides, address(cursor)), splat_whole(1)};
    return walk;
}

/// Whether the group and another one, or itself, hang together and are so flat, with the one
/// between them, that nothing of one can touch the other: all normals are within 60 degrees of one
/// direction (30 of a patch, 15 of its group, half of 30 of both groups), and there is no slit.
/// other   no less than in the calls before
WEFT_INLINE sheet_walk walk_to(sheet_walk walk, WEFT_GLOBAL const float4* tilts,
                               WEFT_GLOBAL const int* besides, WEFT_GLOBAL const int* vias,
                               int other) {
    const whole number = splat_whole(other);
    while (any_item(walk.beside < number)) {
        walk.cursor = walk.beside < number ? walk.cursor + splat_whole(1) : walk.cursor;
        walk.beside = gather_whole(besides, address(walk.cursor));
    }
    const mask hangs = walk.beside == number;
    const whole via = gather_whole(vias, address(walk.cursor));
    const real4 its = splat4(tilts[other]);
    const real4 between = gather4(tilts, address(hangs ? via : walk.group));
    const mask is_flat = both(are_aligned(walk.tilt, its),
                              both(are_aligned(walk.tilt, between), are_aligned(its, between)));
    walk.folds = both(hangs, is_flat) ? splat_whole(0) : splat_whole(1);
    return walk;
}

/// For each group of patches whether any of its patches has to be looked at: 0 where it is one
/// sheet with whatever its bounds overlap with (walk_to); else 1. Boxes of roots and blocks as in
/// find_near_patches.
/// low, high, slant_low, slant_high, tilts   [items] of groups, as enclose_boxes, enclose_slants and
///         tilt_groups leave them
/// beside_begin, besides, vias   of groups, as of patches in find_near_patches
/// opens   [items] written
/// margin  as in find_near_patches [m]
WEFT_NARROW_KERNEL(find_open_groups, WEFT_GLOBAL const float4* root_low,
                   WEFT_GLOBAL const float4* root_high, WEFT_GLOBAL const int* root_begin,
                   WEFT_GLOBAL const float4* block_low, WEFT_GLOBAL const float4* block_high,
                   WEFT_GLOBAL const int* block_begin, WEFT_GLOBAL const float4* low,
                   WEFT_GLOBAL const float4* high, WEFT_GLOBAL const float4* slant_low,
                   WEFT_GLOBAL const float4* slant_high, WEFT_GLOBAL const float4* tilts,
                   WEFT_GLOBAL const int* beside_begin, WEFT_GLOBAL const int* besides,
                   WEFT_GLOBAL const int* vias, WEFT_GLOBAL int* opens, int item_count,
                   int root_count, float margin) {
    const whole none = splat_whole(0);
    const whole one = splat_whole(1);
    const real_bounds bounds =
        widened_bounds(gather_bounds(low, high, slant_low, slant_high, item_numbers(i), item_count),
                       splat(margin));
    const float_box all = around_all(bounds.box);
    sheet_walk walk = begin_walk(tilts, beside_begin, besides, item_numbers(i));
    whole open = walk.tilt.w > splat(0.0f) ? none : one;
    for (int r = 0; r < root_count && any_item(open == none); ++r) {
        if (!meets(all, root_low[r], root_high[r])) continue;
        const int block_end = root_begin[r + 1];
        for (int b = root_begin[r]; b < block_end; ++b) {
            if (!meets(all, block_low[b], block_high[b])) continue;
            const int end = block_begin[b + 1];
            for (int g = block_begin[b]; g < end; ++g) {
                const mask on = both(open == none, overlap_bounds(bounds, low, high, slant_low,
                                                                  slant_high, g, item_count));
                if (!any_item(on)) continue;
                walk = walk_to(walk, tilts, besides, vias, g);
                open = on ? walk.folds : open;
            }
        }
    }
    store_whole(opens, i, open);
}

/// For each patch those whose bounds nearly overlap with its own, itself too, ascending. Left out
/// are
///   what it hangs together with (and itself), by a vertex or by one patch between, while all of
///       them are flat and quiet and face one way: normals are within 60 degrees of one direction,
///       so there is no fold yet, and none comes;
///   what groups of patches say of theirs (walk_to), so that most patches need no look, and
///       those of groups that are not open none at all;
///   two patches that cannot move;  two of one body, where bodies do not touch themselves.
/// Boxes are around boxes: roots (one per strip), blocks, groups, patches. begin of a level: where
/// the children of each box begin in the next one.
/// low, high, slant_low, slant_high   bounds of patches, as enclose_patches leaves them
/// tilts, drifts [items] as tilt_patches says
/// beside_begin  [items + 1] where the list of each begins in `besides`: those that it hangs together
///               with, ascending, and as its end a number that is larger than any; vias: by which
/// group_of      [items] the group of each patch; opens: of groups, as find_open_groups leaves them;
///               group_tilts, group_beside_begin, group_besides,
///               group_vias: of groups, likewise
/// bodies        [items]
/// held          [items] 1: it cannot move
/// margin        by which they may be apart, so that it is known for a while what is near [m]
/// rows, counts, needs, others   a table, as in kernels/neighbours.h
WEFT_NARROW_KERNEL(find_near_patches, WEFT_GLOBAL const float4* root_low,
                   WEFT_GLOBAL const float4* root_high, WEFT_GLOBAL const int* root_begin,
                   WEFT_GLOBAL const float4* block_low, WEFT_GLOBAL const float4* block_high,
                   WEFT_GLOBAL const int* block_begin, WEFT_GLOBAL const float4* group_low,
                   WEFT_GLOBAL const float4* group_high, WEFT_GLOBAL const float4* group_slant_low,
                   WEFT_GLOBAL const float4* group_slant_high, WEFT_GLOBAL const int* group_begin,
                   WEFT_GLOBAL const float4* low, WEFT_GLOBAL const float4* high,
                   WEFT_GLOBAL const float4* slant_low, WEFT_GLOBAL const float4* slant_high,
                   WEFT_GLOBAL const float4* tilts, WEFT_GLOBAL const float4* drifts,
                   WEFT_GLOBAL const int* beside_begin, WEFT_GLOBAL const int* besides,
                   WEFT_GLOBAL const int* vias, WEFT_GLOBAL const int* group_of,
                   WEFT_GLOBAL const int* opens, WEFT_GLOBAL const float4* group_tilts,
                   WEFT_GLOBAL const int* group_beside_begin, WEFT_GLOBAL const int* group_besides,
                   WEFT_GLOBAL const int* group_vias, WEFT_GLOBAL const int* bodies,
                   WEFT_GLOBAL const int* held, WEFT_GLOBAL const int* rows,
                   WEFT_GLOBAL int* counts, WEFT_GLOBAL int* needs, WEFT_GLOBAL int* others,
                   int item_count, int group_count, int root_count, float margin, int touch_self,
                   int instance) {
    open_rows row = open_rows_of(rows, i, item_count);
    const whole own_group = load_whole(group_of, i);
    const whole is_open = gather_whole(opens, address(own_group));
    if (!any_item(is_open > splat_whole(0))) {
        close_rows(row, counts, needs, i, instance);
        return;
    }
    const whole self = item_numbers(i);
    const real_bounds bounds = widened_bounds(
        gather_bounds(low, high, slant_low, slant_high, self, item_count), splat(margin));
    const float_box all = around_all(bounds.box);
    const real_leaning own = {load4(tilts, i), load4(drifts, i)};
    sheet_walk walk = begin_walk(group_tilts, group_beside_begin, group_besides, own_group);
    const whole body = load_whole(bodies, i);
    const whole is_held = load_whole(held, i);
    whole cursor = load_whole(beside_begin, i);
    whole beside = gather_whole(besides, address(cursor));
    for (int r = 0; r < root_count; ++r) {
        if (!meets(all, root_low[r], root_high[r])) continue;
        const int block_end = root_begin[r + 1];
        for (int b = root_begin[r]; b < block_end; ++b) {
            if (!meets(all, block_low[b], block_high[b])) continue;
            const int group_end = block_begin[b + 1];
            for (int g = block_begin[b]; g < group_end; ++g) {
                const mask meet =
                    both(is_open > splat_whole(0),
                         overlap_bounds(bounds, group_low, group_high, group_slant_low,
                                        group_slant_high, g, group_count));
                if (!any_item(meet)) continue;
                walk = walk_to(walk, group_tilts, group_besides, group_vias, g);
                const mask open = both(meet, walk.folds > splat_whole(0));
                if (!any_item(open)) continue;
                const int end = group_begin[g + 1];
                for (int p = group_begin[g]; p < end; ++p) {
                    mask on = both(open, overlap_bounds(bounds, low, high, slant_low, slant_high, p,
                                                        item_count));
                    if (!any_item(on)) continue;
                    if (touch_self == 0) on = both(on, body != splat_whole(bodies[p]));
                    if (held[p] != 0) on = both(on, is_held == splat_whole(0));
                    const real_leaning other = {splat4(tilts[p]), splat4(drifts[p])};
                    const whole smooth = are_smooth(own, other);
                    if (any_item(both(on, smooth > splat_whole(0)))) {
                        const whole number = splat_whole(p);
                        while (any_item(beside < number)) {
                            cursor = beside < number ? cursor + splat_whole(1) : cursor;
                            beside = gather_whole(besides, address(cursor));
                        }
                        const mask is_beside = beside == number;
                        const whole by = gather_whole(vias, address(cursor));
                        const whole between =
                            smooth * is_smooth_by(tilts, drifts, is_beside ? by : number, self,
                                                  number, own, other);
                        const whole skipped = is_beside ? between : splat_whole(0);
                        on = both(on, skipped == splat_whole(0));
                    }
                    row = with_entry(row, on, others, splat_whole(p));
                }
            }
        }
    }
    close_rows(row, counts, needs, i, instance);
}

WEFT_KERNELS_END

#endif
