#ifndef WEFT_KERNELS_OBSTACLES_PLANE_H
#define WEFT_KERNELS_OBSTACLES_PLANE_H

#include "kernels/obstacles/contact.h"

WEFT_KERNELS_BEGIN

/// Everything below y = 0; no dimensions.
WEFT_INLINE nearness near_plane(real3 p, float4 dimensions) {
    const real zero = splat(0.0f);
    nearness near;
    near.distance = p.y;
    near.normal = make3(zero, splat(1.0f), zero);
    (void)dimensions;
    return near;
}

WEFT_OBSTACLE_KERNELS(plane)

WEFT_KERNELS_END

#endif
