#ifndef WEFT_KERNELS_CONTACT_GATES_H
#define WEFT_KERNELS_CONTACT_GATES_H

// Which strips have to do with contact in this substep at all: launches pass over the others
// (only_where() in runtime/launch.h). Over strips.

#include "kernels/contact/boxes.h"

WEFT_KERNELS_BEGIN

/// Where something is to be done about pairs.
/// patch_begin  [items + 1] the patches of each strip
/// near_counts  [patches] how many patches are near
/// kept_counts, stale   [patches] as check_candidates leaves them
/// near         [items] written: 1 where a patch has one near to it, else 0
/// awake        [items] written: 1 there, and where one had some in the substep before; else 0
WEFT_NARROW_KERNEL(find_awake_strips, WEFT_GLOBAL const int* patch_begin,
                   WEFT_GLOBAL const int* near_counts, WEFT_GLOBAL const int* kept_counts,
                   WEFT_GLOBAL const int* stale, WEFT_GLOBAL int* near, WEFT_GLOBAL int* awake,
                   int instance) {
    const whole none = splat_whole(0);
    const whole one = splat_whole(1);
    const whole begin = load_whole(patch_begin, i);
    const whole count = load_whole(patch_begin, column(i, 1, 1)) - begin;
    const whole own = first_of(begin, count);
    const int longest = largest_whole(count);
    whole most_near = none;
    whole most = instance == 0 ? one : none;
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer patch = address(on ? begin + splat_whole(k) : own);
        const whole near_here = gather_whole(near_counts, patch);
        const whole work =
            larger_whole(gather_whole(kept_counts, patch), gather_whole(stale, patch));
        most_near = on ? larger_whole(most_near, near_here) : most_near;
        most = on ? larger_whole(most, work) : most;
    }
    store_whole(near, i, most_near > none ? one : none);
    store_whole(awake, i, larger_whole(most, most_near) > none ? one : none);
}

/// Where vertices may have contacts: their pairs are of the patches of their strip, or of the one
/// before it.
/// near      [items] as find_awake_strips leaves it
/// touching  [items] written: 1 where vertices of the strip may have some, else 0
/// meeting   [items] written: 1 where vertices of the strip or of the next one may
/// filling   [items] written: 1 where vertices of the strip may, or might have had some in the
///           substep before
/// apart     [items] written: 1 where vertices of the strip have none, else 0
WEFT_KERNEL(find_touching_strips, WEFT_GLOBAL const int* near, WEFT_GLOBAL int* touching,
            WEFT_GLOBAL int* meeting, WEFT_GLOBAL int* filling, WEFT_GLOBAL int* apart,
            int item_count, int instance) {
    const whole none = splat_whole(0);
    const whole one = splat_whole(1);
    const whole strip = item_numbers(i);
    const whole last = splat_whole(item_count - 1);
    const whole before = gather_whole(near, address(larger_whole(strip - one, none)));
    const whole behind = gather_whole(near, address(smaller_whole(strip + one, last)));
    const whole now = larger_whole(load_whole(near, i), before);
    const whole was = instance == 0 ? one : load_whole(touching, i);
    store_whole(touching, i, now);
    store_whole(meeting, i, larger_whole(now, behind));
    store_whole(filling, i, larger_whole(now, was));
    store_whole(apart, i, one - now);
}

WEFT_KERNELS_END

#endif
