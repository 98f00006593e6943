#ifndef WEFT_KERNELS_OBSTACLES_SEEN_H
#define WEFT_KERNELS_OBSTACLES_SEEN_H

#include "kernels/lanes.h"
#include "kernels/obstacles/shapes.h"

WEFT_KERNELS_BEGIN

/// As the kernel of the obstacle's shape sees a vertex at x that was at `start`. The normal is the
/// obstacle's frame's.
WEFT_INLINE nearness seen_from(WEFT_GLOBAL const float4* o, real3 start, real3 x) {
#define WEFT_TRY_SHAPE(name) \
    if (o[7].w == WEFT_OBSTACLE_##name) return seen_from_##name(o, start, x);
    WEFT_FOR_EACH_OBSTACLE_SHAPE(WEFT_TRY_SHAPE)
#undef WEFT_TRY_SHAPE
    return near_plane(x, o[6]);
}

WEFT_KERNELS_END

#endif
