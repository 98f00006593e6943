#ifndef WEFT_KERNELS_CONTACT_NEARING_H
#define WEFT_KERNELS_CONTACT_NEARING_H

// How long candidates for pairs last (candidates.h; neighbour lists with a skin: Verlet 1967). A
// patch has collected all that would be a pair of one of its items if it were nearer to it by the
// patch's slack. Since then, two points of two patches have come nearer to each other by no more
// than what their strides differed by in each substep, and their reaches have grown by no more than
// the most that one has grown in each. Once that is more than the slack, the patch collects anew;
// but not for another one while their bounds are apart, nor for one that comes near from afar until
// it has used up what is between them. And it does where another one is passed over that it has
// taken for near (near.h), or no longer is: what pairs they have is not a matter of how far they
// are.
//
// What is a pair is looked at in every substep (pairs.h), so how long candidates last decides what
// that costs, and nothing else.

#include "kernels/contact/overlap.h"

WEFT_KERNELS_BEGIN

/// Of patches of which nobody follows how far they move.
#define WEFT_UNKNOWN_STRIDE 1e15f

/// Bounds of the strides of a patch's vertices: how far they have come since the substep before
/// [m]. w of high: the most that one's reach has grown [m]
typedef struct {
    real4 low, high;
} real_strides;

WEFT_INLINE real_strides gather_strides(WEFT_GLOBAL const float4* low,
                                        WEFT_GLOBAL const float4* high, whole patch) {
    const integer p = address(patch);
    real_strides strides = {gather4(low, p), gather4(high, p)};
    return strides;
}

/// By how much points of two patches, with their reaches, have come nearer to each other at most.
WEFT_INLINE real nearing(real_strides a, real_strides b) {
    const real3 apart = make3(larger(a.high.x - b.low.x, b.high.x - a.low.x),
                              larger(a.high.y - b.low.y, b.high.y - a.low.y),
                              larger(a.high.z - b.low.z, b.high.z - a.low.z));
    return length3(apart) + (a.high.w + b.high.w);
}

/// Bounds of strides, of patches that others are near to.
/// strides     [vertices] as begin_contacts leaves them
/// hull_begin, hulls   as in enclose_patches
/// counts      [items] how many patches each has near to it, as far as it knows
/// low, high   [items] written
WEFT_NARROW_KERNEL(enclose_strides, WEFT_GLOBAL const float4* strides,
                   WEFT_GLOBAL const int* hull_begin, WEFT_GLOBAL const int* hulls,
                   WEFT_GLOBAL const int* counts, WEFT_GLOBAL float4* low,
                   WEFT_GLOBAL float4* high) {
    const real far = splat(WEFT_UNKNOWN_STRIDE);
    const whole none = splat_whole(0);
    const mask counts_here = load_whole(counts, i) > none;
    real_box box = empty_box();
    real growth = -far;
    if (any_item(counts_here)) {
        const whole begin = load_whole(hull_begin, i);
        const whole last = load_whole(hull_begin, column(i, 1, 1)) - splat_whole(1);
        const int longest = largest_whole(counts_here ? last - begin : none) + 1;
        for (int k = 0; k < longest; ++k) {
            const integer entry = address(smaller_whole(begin + splat_whole(k), last));
            const real4 stride = gather4(strides, address(gather_whole(hulls, entry)));
            real_box of_vertex;
            of_vertex.low = of_vertex.high = xyz(stride);
            box = united(box, of_vertex);
            growth = larger(stride.w, growth);
        }
    }
    const real4 bottom = {counts_here ? box.low.x : -far, counts_here ? box.low.y : -far,
                          counts_here ? box.low.z : -far, splat(0.0f)};
    const real4 top = {counts_here ? box.high.x : far, counts_here ? box.high.y : far,
                       counts_here ? box.high.z : far, counts_here ? growth : splat(0.0f)};
    store4(low, i, bottom);
    store4(high, i, top);
}

/// The entry of a row of patches, or a number larger than any behind its end.
WEFT_INLINE whole patch_at(WEFT_GLOBAL const int* others, whole start, whole count, whole n) {
    const mask on = n < count;
    const whole place = on ? start + n * splat_whole(WEFT_ROW_STRIDE) : start;
    return on ? gather_whole(others, address(place)) : splat_whole(0x7fffffff);
}

/// How far apart two patches are at least, beyond their reaches; negative where their bounds
/// overlap.
WEFT_INLINE real clearance(real_bounds a, real_bounds b) {
    const real slanted =
        larger(box_distance(a.sums, b.sums), box_distance(a.differences, b.differences));
    return larger(box_distance(a.box, b.box), splat(1.0f / WEFT_SLANT) * slanted);
}

/// Makes room for an entry at place k of the rows that `on` holds for.
/// counts  how many entries they have; there is room for another one
WEFT_INLINE void move_up(mask on, int k, whole start, whole counts, WEFT_GLOBAL int* others,
                         WEFT_GLOBAL float* spent) {
    const int end = largest_whole(on ? counts : splat_whole(0));
    for (int n = end; n > k; --n) {
        const mask moves = both(on, splat_whole(n) <= counts);
        const integer from =
            address(moves ? start + splat_whole(WEFT_ROW_STRIDE * (n - 1)) : start);
        const integer to = address(moves ? start + splat_whole(WEFT_ROW_STRIDE * n) : start);
        const whole other = gather_whole(others, from);
        const real way = gather(spent, from);
        scatter_whole_where(moves, others, to, other);
        scatter_where(moves, spent, to, way);
    }
}

/// Rows of what is near, of which nothing has come nearer yet, as far as there is room; and by how
/// much something of it does in this substep at most [m].
/// near_start, near_counts, near_others   what is near; 0 where rows stay as they are
/// start, room, others, spent   of the rows
WEFT_INLINE real keep_what_is_near(real_strides own, WEFT_GLOBAL const float4* stride_low,
                                   WEFT_GLOBAL const float4* stride_high, whole near_start,
                                   whole near_counts, WEFT_GLOBAL const int* near_others,
                                   whole start, whole room, WEFT_GLOBAL int* others,
                                   WEFT_GLOBAL float* spent) {
    const int longest = largest_whole(near_counts);
    real rate = splat(0.0f);
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < near_counts;
        const whole listed = patch_at(near_others, near_start, near_counts, splat_whole(k));
        const whole other = on ? listed : splat_whole(0);
        const real step = nearing(own, gather_strides(stride_low, stride_high, other));
        rate = on ? larger(rate, step) : rate;
        const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
        const mask fits = both(on, splat_whole(k) < room);
        scatter_whole_where(fits, others, entry, other);
        scatter_where(fits, spent, entry, splat(0.0f));
    }
    return rate;
}

/// Which patches have to collect their candidates anew, and with how much slack.
/// low, high, slant_low, slant_high   bounds of patches, as enclose_patches leaves them
/// stride_low, stride_high   [items] as enclose_strides leaves them
/// near_rows, near_counts, near_others   the table of find_near_patches
/// rows, counts, needs, others   a table: what was near when candidates were collected, or has come
///             near since
/// spent       [entries] how much nearer it may have come since [m]
/// slacks      [items] how much nearer it may come [m]
/// stamps      [items] when candidates were collected: not 0
/// stale       [items] written: 1: to be collected anew
/// epoch, age0 to age3   [1] their sum tells whether tables are still those of a stamp
/// margin      as in find_near_patches [m]
/// spare       by how much less than their bounds patches count as apart: for rounding [m]
/// least, most slack [m]
/// substeps    of the present speed that slack is for
/// worthwhile  if the most slack would not last for so many of them, there is none: collecting with
///             slack takes longer
WEFT_NARROW_KERNEL(check_candidates, WEFT_GLOBAL const float4* low, WEFT_GLOBAL const float4* high,
                   WEFT_GLOBAL const float4* slant_low, WEFT_GLOBAL const float4* slant_high,
                   WEFT_GLOBAL const float4* stride_low, WEFT_GLOBAL const float4* stride_high,
                   WEFT_GLOBAL const int* near_rows, WEFT_GLOBAL const int* near_counts,
                   WEFT_GLOBAL const int* near_others, WEFT_GLOBAL const int* rows,
                   WEFT_GLOBAL int* counts, WEFT_GLOBAL int* needs, WEFT_GLOBAL int* others,
                   WEFT_GLOBAL float* spent, WEFT_GLOBAL float* slacks, WEFT_GLOBAL int* stamps,
                   WEFT_GLOBAL int* stale, WEFT_GLOBAL const int* epoch,
                   WEFT_GLOBAL const int* age0, WEFT_GLOBAL const int* age1,
                   WEFT_GLOBAL const int* age2, WEFT_GLOBAL const int* age3, int item_count,
                   float margin, float spare, float least, float most, float substeps,
                   float worthwhile, int instance) {
    const whole none = splat_whole(0);
    const whole one = splat_whole(1);
    const whole now = splat_whole(epoch[0] + age0[0] + age1[0] + age2[0] + age3[0]);
    const whole stamp = load_whole(stamps, i);
    const whole near_start = load_whole(near_rows, i);
    const whole near_count = load_whole(near_counts, i);
    const whole before = load_whole(counts, i);
    whole kept = stamp == now ? before : none;
    whole is_stale = stamp == now ? none : one;
    if (any_item(kept + near_count + is_stale > none)) {
        const whole start = load_whole(rows, i);
        const whole room = load_whole(rows, column(i, item_count, 1));
        real slack = load(slacks, i);
        const real_strides own = {load4(stride_low, i), load4(stride_high, i)};
        const real_bounds bounds =
            gather_bounds(low, high, slant_low, slant_high, item_numbers(i), item_count);
        const real_bounds around = widened_bounds(bounds, splat(margin));
        // Where nothing is near any more, nothing is kept.
        is_stale = near_count > none ? is_stale : larger_whole(is_stale, smaller_whole(kept, one));
        whole n = none;
        mask on = both(is_stale == none, larger_whole(kept, near_count) > none);
        for (int k = 0; any_item(on); ++k) {
            const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
            const whole listed = patch_at(others, start, kept, splat_whole(k));
            const whole found = patch_at(near_others, near_start, near_count, n);
            const mask comes = both(on, found < listed);
            const mask enters = both(comes, kept < room);
            const whole lacks_room = comes ? (enters ? none : one) : none;
            if (any_item(enters)) {
                move_up(enters, k, start, kept, others, spent);
                scatter_whole_where(enters, others, entry, found);
                kept = enters ? kept + one : kept;
            }
            const whole other = on ? smaller_whole(listed, found) : none;
            const whole is_near = found == other ? one : none;
            const real so_far = comes ? splat(WEFT_UNKNOWN_STRIDE) : gather(spent, entry);
            real sum = so_far + nearing(own, gather_strides(stride_low, stride_high, other));
            whole is_passed_over = none;
            const whole seems_near = sum <= slack ? none : one;
            const mask is_asked = both(on, one - is_near + seems_near > none);
            if (any_item(is_asked)) {
                const real_bounds its =
                    gather_bounds(low, high, slant_low, slant_high, other, item_count);
                const real apart = clearance(bounds, its) - splat(spare);
                sum = is_asked ? smaller(sum, slack - apart) : sum;
                // It is not near, but not for being far.
                is_passed_over = bounds_overlap(around, its) ? one - is_near : none;
            }
            scatter_where(both(on, lacks_room == none), spent, entry, sum);
            const whole too_near = sum <= slack ? none : one;
            const whole has_changed = larger_whole(too_near, is_passed_over) + lacks_room;
            is_stale = on ? larger_whole(is_stale, has_changed) : is_stale;
            n = n + is_near;
            const whole left = larger_whole(kept - splat_whole(k + 1), near_count - n);
            on = both(on, both(is_stale == none, left > none));
        }
        const mask anew = is_stale > none;
        if (any_item(anew)) {
            const real rate = keep_what_is_near(own, stride_low, stride_high, near_start,
                                                anew ? near_count : none, near_others, start, room,
                                                others, spent);
            const real wanted = smaller(larger(splat(substeps) * rate, splat(least)), splat(most));
            const real given = splat(worthwhile) * rate <= splat(most) ? wanted : splat(0.0f);
            slack = anew ? given : slack;
            store(slacks, i, slack);
            store_whole(stamps, i, anew ? now : stamp);
        }
        store_whole(counts, i, anew ? smaller_whole(near_count, room) : kept);
    }
    store_whole(stale, i, is_stale);
    store_whole(needs, i,
                instance == 0 ? near_count : larger_whole(near_count, load_whole(needs, i)));
}

WEFT_KERNELS_END

#endif
