#ifndef WEFT_KERNELS_OBSTACLES_NEAREST_H
#define WEFT_KERNELS_OBSTACLES_NEAREST_H

#include "kernels/lanes.h"
#include "kernels/obstacles/core.h"
#include "kernels/obstacles/seen.h"

WEFT_KERNELS_BEGIN

/// Where a vertex is on an obstacle.
typedef struct {
    real gap;       ///< [m], negative within the thickness
    real beside;    ///< from the next obstacle but this [m]
    real friction;  ///< coefficient
    real3 normal;   ///< of length 1, outwards
    real3 slip;     ///< along the surface since the substep began [m]
} surface_contact;

/// The nearest of all obstacles.
/// obstacles  those of the substep
WEFT_INLINE surface_contact nearest_surface(WEFT_GLOBAL const float4* obstacles, int obstacle_count,
                                            real3 before, real3 x) {
    const real zero = splat(0.0f);
    const real far = splat(3e38f);
    surface_contact c = {far, far, zero, make3(zero, zero, zero), make3(zero, zero, zero)};
    for (int number = 0; number < obstacle_count; ++number) {
        WEFT_GLOBAL const float4* o = obstacles + WEFT_OBSTACLE_ROWS * number;
        const nearness near = seen_from(o, before, x);
        const real gap = near.distance - splat(o[7].x);
        const real3 normal = apply_back(o, near.normal);
        const real3 slip = slid_along(o, x, before, normal);
        const mask is_nearer = gap < c.gap;
        const real farther = is_nearer ? c.gap : gap;
        c.beside = smaller(c.beside, farther);
        c.gap = is_nearer ? gap : c.gap;
        c.friction = is_nearer ? splat(o[7].y) : c.friction;
        c.normal = either(is_nearer, normal, c.normal);
        c.slip = either(is_nearer, slip, c.slip);
    }
    return c;
}

WEFT_KERNELS_END

#endif
