#ifndef WEFT_KERNELS_CONTACT_NEAR_H
#define WEFT_KERNELS_CONTACT_NEAR_H

#include "kernels/contact/overlap.h"

WEFT_KERNELS_BEGIN

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

/// Whether two groups of patches are flat and quiet, and face the same way within 30 degrees.
WEFT_INLINE int are_aligned(float4 a, float4 b) {
    return a.w > 0.0f && b.w > 0.0f && a.x * b.x + a.y * b.y + a.z * b.z >= 0.8660f;
}

/// Whether a group and another one, or itself, hang together and are so flat, with the one between
/// them, that nothing of one can touch the other: all normals are within 60 degrees of one
/// direction (30 of a patch, 15 of its group, half of 30 of both groups), and there is no slit.
/// tilts   as tilt_groups leaves them
/// begin, besides, vias   of groups, as of patches in find_near_patches
WEFT_INLINE int are_one_sheet(WEFT_GLOBAL const float4* tilts, WEFT_GLOBAL const int* begin,
                              WEFT_GLOBAL const int* besides, WEFT_GLOBAL const int* vias,
                              int group, int other) {
    if (!are_aligned(tilts[group], tilts[other])) return 0;
    int entry = begin[group];
    while (besides[entry] < other) ++entry;
    if (besides[entry] != other) return 0;
    const float4 between = tilts[vias[entry]];
    return are_aligned(between, tilts[group]) && are_aligned(between, tilts[other]);
}

/// 1 for the items at hand whose patches have to be looked at, with those of a group.
/// own           the group of each
/// first, last   the first and the last of these
WEFT_INLINE whole may_fold_onto(WEFT_GLOBAL const float4* tilts, WEFT_GLOBAL const int* begin,
                                WEFT_GLOBAL const int* besides, WEFT_GLOBAL const int* vias,
                                whole own, int first, int last, int other) {
    whole open = splat_whole(1);
    for (int group = first; group <= last; ++group) {
        if (!are_one_sheet(tilts, begin, besides, vias, group, other)) continue;
        open = own == splat_whole(group) ? splat_whole(0) : open;
    }
    return open;
}

/// For each patch those whose bounds nearly overlap with its own, itself too, ascending. Left out
/// are
///   what it hangs together with (and itself), by a vertex or by one patch between, while all of
///       them are flat and quiet and face one way: normals are within 60 degrees of one direction,
///       so there is no fold yet, and none comes;
///   what groups of patches say of theirs (are_one_sheet), so that most patches need no look;
///   two patches that cannot move;  two of one body, where bodies do not touch themselves.
/// Boxes are around boxes: roots (one per strip), blocks, groups, patches. begin of a level: where
/// the children of each box begin in the next one.
/// low, high, slant_low, slant_high   bounds of patches, as enclose_patches leaves them
/// tilts, drifts [items] as tilt_patches says
/// beside_begin  [items + 1] where the list of each begins in `besides`: those that it hangs together
///               with, ascending, and as its end a number that is larger than any; vias: by which
/// group_of      [items] the group of each patch; group_tilts, group_beside_begin, group_besides,
///               group_vias: of groups, likewise
/// bodies        [items]
/// held          [items] 1: it cannot move
/// margin        by which they may be apart, so that it is known for a while what is near [m]
/// rows, counts, needs, others   a table, as in kernels/neighbours.h
WEFT_NARROW_KERNEL(find_near_patches, WEFT_GLOBAL const float4* root_low,
                   WEFT_GLOBAL const float4* root_high, WEFT_GLOBAL const int* root_begin,
                   WEFT_GLOBAL const float4* block_low, WEFT_GLOBAL const float4* block_high,
                   WEFT_GLOBAL const int* block_begin, WEFT_GLOBAL const float4* group_low,
                   WEFT_GLOBAL const float4* group_high, WEFT_GLOBAL const int* group_begin,
                   WEFT_GLOBAL const float4* low, WEFT_GLOBAL const float4* high,
                   WEFT_GLOBAL const float4* slant_low, WEFT_GLOBAL const float4* slant_high,
                   WEFT_GLOBAL const float4* tilts, WEFT_GLOBAL const float4* drifts,
                   WEFT_GLOBAL const int* beside_begin, WEFT_GLOBAL const int* besides,
                   WEFT_GLOBAL const int* vias, WEFT_GLOBAL const int* group_of,
                   WEFT_GLOBAL const float4* group_tilts, WEFT_GLOBAL const int* group_beside_begin,
                   WEFT_GLOBAL const int* group_besides, WEFT_GLOBAL const int* group_vias,
                   WEFT_GLOBAL const int* bodies, WEFT_GLOBAL const int* held,
                   WEFT_GLOBAL const int* rows, WEFT_GLOBAL int* counts, WEFT_GLOBAL int* needs,
                   WEFT_GLOBAL int* others, int item_count, int root_count, float margin,
                   int touch_self, int instance) {
    const whole self = item_numbers(i);
    const real_bounds bounds = widened_bounds(
        gather_bounds(low, high, slant_low, slant_high, self, item_count), splat(margin));
    const float_box all = around_all(bounds.box);
    const real_leaning own = {load4(tilts, i), load4(drifts, i)};
    const whole own_group = load_whole(group_of, i);
    const int first_group = group_of[i.first];
    const int last_group = group_of[i.first + i.count - 1];
    const whole body = load_whole(bodies, i);
    const whole is_held = load_whole(held, i);
    whole cursor = load_whole(beside_begin, i);
    whole beside = gather_whole(besides, address(cursor));
    open_rows row = open_rows_of(rows, i, item_count);
    for (int r = 0; r < root_count; ++r) {
        if (!meets(all, root_low[r], root_high[r])) continue;
        const int block_end = root_begin[r + 1];
        for (int b = root_begin[r]; b < block_end; ++b) {
            if (!meets(all, block_low[b], block_high[b])) continue;
            const int group_end = block_begin[b + 1];
            for (int g = block_begin[b]; g < group_end; ++g) {
                if (!meets(all, group_low[g], group_high[g])) continue;
                const whole open = may_fold_onto(group_tilts, group_beside_begin, group_besides,
                                                 group_vias, own_group, first_group, last_group, g);
                if (!any_item(open > splat_whole(0))) continue;
                const int end = group_begin[g + 1];
                for (int p = group_begin[g]; p < end; ++p) {
                    mask on = both(open > splat_whole(0), overlaps(bounds.box, low[p], high[p]));
                    if (!any_item(on)) continue;
                    on = both(on, overlaps(bounds.sums, slant_low[p], slant_high[p]));
                    on = both(on, overlaps(bounds.differences, slant_low[item_count + p],
                                           slant_high[item_count + p]));
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
