#ifndef WEFT_KERNELS_EXCHANGE_H
#define WEFT_KERNELS_EXCHANGE_H

// What devices that work on iterates of their own make of each other's: see
// docs/asynchronous-gauss-seidel.md.

#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// Merges what two devices did to what they both started from. What only one of them has moved is
/// taken as it is.
/// own           [vertices] xyz [m], w kept; what both make of it
/// start         [vertices] where both started from
/// input         [vertices] the other one's
/// own_weight    of a motion where both have moved
/// input_weight  likewise
WEFT_KERNEL(merge_displacements, WEFT_GLOBAL float4* own, WEFT_GLOBAL const float4* start,
            WEFT_GLOBAL const float4* input, float own_weight, float input_weight) {
    const real4 x = load4(own, i);
    const real3 s = xyz(load4(start, i));
    const real3 in = xyz(load4(input, i));
    const real3 a = subtract(xyz(x), s);
    const real3 b = subtract(in, s);
    const real moved_a = dot3(a, a);
    const real moved_b = dot3(b, b);
    const real zero = splat(0.0f);
    const real3 sum = add_scaled(add_scaled(s, a, splat(own_weight)), b, splat(input_weight));
    const real3 alone = make3(moved_a > zero ? x.x : in.x, moved_a > zero ? x.y : in.y,
                              moved_a > zero ? x.z : in.z);
    // Positive only where both have moved.
    const real both = smaller(moved_a, moved_b);
    const real3 merged = make3(both > zero ? sum.x : alone.x, both > zero ? sum.y : alone.y,
                               both > zero ? sum.z : alone.z);
    store4(own, i, with_w(merged, x.w));
}

/// The mean of two positions, wherever they started.
/// own    [vertices] xyz [m], w kept
/// input  [vertices]
WEFT_KERNEL(average_positions, WEFT_GLOBAL float4* own, WEFT_GLOBAL const float4* input) {
    const real4 x = load4(own, i);
    const real3 mean = scale(add(xyz(x), xyz(load4(input, i))), splat(0.5f));
    store4(own, i, with_w(mean, x.w));
}

WEFT_KERNELS_END

#endif
