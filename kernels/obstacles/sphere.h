#ifndef WEFT_KERNELS_OBSTACLES_SPHERE_H
#define WEFT_KERNELS_OBSTACLES_SPHERE_H

#include "kernels/obstacles/ball.h"
#include "kernels/obstacles/contact.h"

WEFT_KERNELS_BEGIN

/// A sphere around the origin; dimensions.x = radius.
WEFT_INLINE nearness near_sphere(real3 p, float4 dimensions) { return near_ball(p, dimensions.x); }

WEFT_OBSTACLE_KERNELS(sphere)

WEFT_KERNELS_END

#endif
