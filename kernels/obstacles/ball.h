#ifndef WEFT_KERNELS_OBSTACLES_BALL_H
#define WEFT_KERNELS_OBSTACLES_BALL_H

#include "kernels/obstacles/contact.h"

WEFT_KERNELS_BEGIN

/// A ball around the origin. At its very centre every way out is as short: upwards.
WEFT_INLINE nearness near_ball(real3 p, float radius) {
    const real zero = splat(0.0f);
    const real length = length3(p);
    const real shrink = splat(1.0f) / divisor(length);
    nearness near;
    near.distance = length - splat(radius);
    near.normal.x = p.x * shrink;
    near.normal.y = length > zero ? p.y * shrink : splat(1.0f);
    near.normal.z = p.z * shrink;
    return near;
}

WEFT_KERNELS_END

#endif
