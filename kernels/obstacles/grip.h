#ifndef WEFT_KERNELS_OBSTACLES_GRIP_H
#define WEFT_KERNELS_OBSTACLES_GRIP_H

// What friction on obstacles may still take back of a vertex' way in a substep [m]. It is beside
// x~, which pushes by obstacles lead along, as they do not count as momentum that is missing.

#include "kernels/vector.h"

/// At least this is it where an obstacle has pushed the vertex in the substep, however far it has
/// slid; otherwise 0. (Cloth that is pushed is not turned as a whole: bodies/moments.h.)
#define WEFT_NO_GRIP 1e-30f

WEFT_KERNELS_BEGIN

/// What is left of it behind a push.
/// grip  before
/// gain  what the push has added
/// used  what friction has taken back
WEFT_INLINE real grip_left(real grip, real gain, real used) {
    return larger(grip + gain - used, smaller(grip, splat(WEFT_NO_GRIP)));
}

/// The grip of what has just been pushed so far.
WEFT_INLINE real grip_of_pushed(real grip, real push) {
    return larger(grip, push > splat(0.0f) ? splat(WEFT_NO_GRIP) : splat(0.0f));
}

/// The part of a push along what presses.
/// pressing  as in obstacles/contact.h; 0: nothing presses
WEFT_INLINE real3 pushed_along(real3 push, real3 pressing) {
    const real size = dot3(pressing, pressing);
    const real part = dot3(push, pressing) / (size > splat(0.0f) ? size : splat(1.0f));
    return scale(pressing, part);
}

WEFT_KERNELS_END

#endif
