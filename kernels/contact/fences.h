#ifndef WEFT_KERNELS_CONTACT_FENCES_H
#define WEFT_KERNELS_CONTACT_FENCES_H

#include "kernels/contact/boxes.h"

WEFT_KERNELS_BEGIN

/// 1 where a box is within another one.
WEFT_INLINE whole is_within(real3 low, real3 high, real4 fence_low, real4 fence_high) {
    const mask from = both(both(low.x >= fence_low.x, low.y >= fence_low.y), low.z >= fence_low.z);
    const mask to =
        both(both(high.x <= fence_high.x, high.y <= fence_high.y), high.z <= fence_high.z);
    return both(from, to) ? splat_whole(1) : splat_whole(0);
}

/// Whether patches stay in a substep where they were expected. Groups of bodies that move by
/// translations of their own have fences that are apart from each other, so that nobody has to look
/// for what the others may do there. Who leaves one makes the frame be done again, without.
/// low, high    [items] boxes around all that the patch may reach from its anchors
/// bodies       [items]
/// carried      [substeps * body_count] xyz: by how much anchors are ahead of x_t (begin.h) [m]
/// chunks       [items] whose fence is the patch's
/// fences       [substeps * 2 * chunk_count] low, high corner [m]
/// strays       [items] written: 1 where the patch left its fence since instance 0, else 0
WEFT_KERNEL(find_strays, WEFT_GLOBAL const float4* low, WEFT_GLOBAL const float4* high,
            WEFT_GLOBAL const int* bodies, WEFT_GLOBAL const float4* carried,
            WEFT_GLOBAL const int* chunks, WEFT_GLOBAL const float4* fences,
            WEFT_GLOBAL int* strays, int body_count, int chunk_count, int instance) {
    WEFT_GLOBAL const float4* lows = fences + 2 * chunk_count * instance;
    const integer chunk = load_index(chunks, i);
    const real4 from = gather4(lows, chunk);
    const real4 to = gather4(lows + chunk_count, chunk);
    const real3 ahead = xyz(gather4(carried + body_count * instance, load_index(bodies, i)));
    const real3 a = xyz(load4(low, i));
    const real3 b = xyz(load4(high, i));
    const whole now = is_within(a, b, from, to);
    const whole before = is_within(subtract(a, ahead), subtract(b, ahead), from, to);
    const whole strays_now = splat_whole(1) - now * before;
    store_whole(strays, i,
                instance == 0 ? strays_now : larger_whole(strays_now, load_whole(strays, i)));
}

WEFT_KERNELS_END

#endif
