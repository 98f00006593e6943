#ifndef WEFT_KERNELS_OBSTACLES_BOX_H
#define WEFT_KERNELS_OBSTACLES_BOX_H

#include "kernels/obstacles/contact.h"

WEFT_KERNELS_BEGIN

/// A box around the origin; dimensions.xyz = half its widths.
WEFT_INLINE nearness near_box(real3 p, float4 dimensions) {
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const real3 side =
        make3(p.x < zero ? -one : one, p.y < zero ? -one : one, p.z < zero ? -one : one);
    const real3 beyond =
        make3(p.x * side.x - splat(dimensions.x), p.y * side.y - splat(dimensions.y),
              p.z * side.z - splat(dimensions.z));

    // Outside: towards the closest point of the box. Inside: out through the closest face.
    const real3 gap = make3(larger(beyond.x, zero), larger(beyond.y, zero), larger(beyond.z, zero));
    const real outside = length3(gap);
    const real inside = larger(beyond.x, larger(beyond.y, beyond.z));
    const real face_x = beyond.x >= inside ? one : zero;
    const real face_y = beyond.y >= inside ? one - face_x : zero;
    const real face_z = one - face_x - face_y;

    const real shrink = one / divisor(outside);
    nearness near;
    near.distance = outside > zero ? outside : inside;
    near.normal.x = side.x * (outside > zero ? gap.x * shrink : face_x);
    near.normal.y = side.y * (outside > zero ? gap.y * shrink : face_y);
    near.normal.z = side.z * (outside > zero ? gap.z * shrink : face_z);
    return near;
}

WEFT_OBSTACLE_KERNELS(box)

WEFT_KERNELS_END

#endif
