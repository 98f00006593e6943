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

/// 1 where a third patch lies as the two between which it is, and goes as they do.
WEFT_INLINE whole is_smooth_by(WEFT_GLOBAL const float4* tilts, WEFT_GLOBAL const float4* drifts,
                               whole via, real_leaning a, real_leaning b) {
    const integer patch = address(via);
    const real_leaning between = {gather4(tilts, patch), gather4(drifts, patch)};
    return are_smooth(between, a) * are_smooth(between, b);
}

/// For each patch those whose boxes nearly overlap with its own, itself too, ascending. Left out
/// are
///   what it hangs together with (and itself), by a vertex or by one patch between, while all of
///       them are flat and quiet and face one way: normals are within 60 degrees of one direction,
///       so there is no fold yet, and none comes;
///   two patches that cannot move;  two of one body, where bodies do not touch themselves.
/// Boxes are around boxes: roots (one per strip), blocks, groups, patches. begin of a level: where
/// the children of each box begin in the next one.
/// low, high     [items] boxes of patches
/// tilts, drifts [items] as tilt_patches says
/// beside_begin  [items + 1] where the list of each begins in `besides`: those that it hangs together
///               with, ascending, and as its end a number that is larger than any; vias: by which
/// bodies        [items]
/// held          [items] 1: it cannot move
/// margin        by which boxes may be apart, so that it is known for a while what is near [m]
/// rows, counts, needs, others   a table, as in kernels/neighbours.h
WEFT_KERNEL(find_near_patches, WEFT_GLOBAL const float4* root_low,
            WEFT_GLOBAL const float4* root_high, WEFT_GLOBAL const int* root_begin,
            WEFT_GLOBAL const float4* block_low, WEFT_GLOBAL const float4* block_high,
            WEFT_GLOBAL const int* block_begin, WEFT_GLOBAL const float4* group_low,
            WEFT_GLOBAL const float4* group_high, WEFT_GLOBAL const int* group_begin,
            WEFT_GLOBAL const float4* low, WEFT_GLOBAL const float4* high,
            WEFT_GLOBAL const float4* tilts, WEFT_GLOBAL const float4* drifts,
            WEFT_GLOBAL const int* beside_begin, WEFT_GLOBAL const int* besides,
            WEFT_GLOBAL const int* vias, WEFT_GLOBAL const int* bodies, WEFT_GLOBAL const int* held,
            WEFT_GLOBAL const int* rows, WEFT_GLOBAL int* counts, WEFT_GLOBAL int* needs,
            WEFT_GLOBAL int* others, int item_count, int root_count, float margin, int self,
            int instance) {
    real_box box;
    box.low = xyz(load4(low, i));
    box.high = xyz(load4(high, i));
    box = widened(box, splat(margin));
    const float_box all = around_all(box);
    const real_leaning own = {load4(tilts, i), load4(drifts, i)};
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
                const int end = group_begin[g + 1];
                for (int p = group_begin[g]; p < end; ++p) {
                    const float4 p_low = low[p];
                    const float4 p_high = high[p];
                    if (!meets(all, p_low, p_high)) continue;
                    mask on = overlaps(box, p_low, p_high);
                    if (self == 0) on = both(on, body != splat_whole(bodies[p]));
                    if (held[p] != 0) on = both(on, is_held == splat_whole(0));
                    const real_leaning other = {splat4(tilts[p]), splat4(drifts[p])};
                    const whole smooth = are_smooth(own, other);
                    if (any_item(both(on, smooth > splat_whole(0)))) {
                        const whole number = splat_whole(p);
                        while (any_item(beside < number)) {
                            cursor = beside < number ? cursor + splat_whole(1) : cursor;
                            beside = gather_whole(besides, address(cursor));
                        }
                        const whole by = gather_whole(vias, address(cursor));
                        const whole between = smooth * is_smooth_by(tilts, drifts, by, own, other);
                        const whole skipped = beside == number ? between : splat_whole(0);
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
