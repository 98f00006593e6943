#ifndef WEFT_KERNELS_OBSTACLES_CAPSULE_H
#define WEFT_KERNELS_OBSTACLES_CAPSULE_H

#include "kernels/obstacles/ball.h"
#include "kernels/obstacles/contact.h"

WEFT_KERNELS_BEGIN

/// A segment along y around the origin; dimensions.x = radius, dimensions.y = half its length.
WEFT_INLINE nearness near_capsule(real3 p, float4 dimensions) {
    const real reach = splat(dimensions.y);
    const real along = smaller(larger(p.y, -reach), reach);
    return near_ball(make3(p.x, p.y - along, p.z), dimensions.x);
}

WEFT_OBSTACLE_KERNELS(capsule)

WEFT_KERNELS_END

#endif
