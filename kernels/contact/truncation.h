#ifndef WEFT_KERNELS_CONTACT_TRUNCATION_H
#define WEFT_KERNELS_CONTACT_TRUNCATION_H

// What keeps surfaces from passing through each other, whatever a solver does. Each vertex has an
// anchor a, where it was when contacts were looked for, a ball around it, and for each contact a
// plane, which may move during the substep: it lies between the two surfaces at the beginning, and
// vertices that end on their side of where it ends have been on their side all the way, as ways are
// straight. So none needs to know what others did. In terms of the way D = x - a, n away from the
// other surface,
//
//   |D| <= rho          n . D >= -room
//
// and all of these hold at a foothold B: at a itself (B = 0), but where a surface that is led by
// the scene comes nearer.

#include "kernels/lanes.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

/// What a substep's start leaves between plane and surface, in ranges of contact; no truncation
/// asks for more, but for the slack that all leave.
#define WEFT_CONTACT_START_SLACK 0.25f

/// The room before its planes of a vertex that has no pairs [m].
#define WEFT_NO_PLANE 1e30f

WEFT_KERNELS_BEGIN

/// How far a vertex may go towards a plane: some slack stays, as far as there was any.
WEFT_INLINE real room_before(real distance, real slack) {
    const real zero = splat(0.0f);
    return distance > slack ? distance - slack : smaller(distance, zero);
}

/// The way without what leads through the plane. A little more is taken out: what rounding leaves
/// of it would stop the vertex where there is no room at all.
WEFT_INLINE real3 keep_before(real3 way, real3 normal, real room) {
    const real missing = smaller(dot3(way, normal) + room, splat(0.0f));
    return add_scaled(way, normal, splat(-1.0001f) * missing);
}

/// How much of the way from the foothold on may be gone: 1 where it stays before the plane.
WEFT_INLINE real share_before(real3 foothold, real3 way, real3 normal, real room) {
    const real start = larger(dot3(foothold, normal) + room, splat(0.0f));
    const real end = dot3(way, normal) + room;
    const real fall = larger(start - end, splat(1e-30f));
    return end < splat(0.0f) ? start / fall : splat(1.0f);
}

WEFT_INLINE real3 between3(real3 from, real3 to, real share) {
    return add_scaled(from, subtract(to, from), share);
}

WEFT_KERNELS_END

#endif
