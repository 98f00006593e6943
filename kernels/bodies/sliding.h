#ifndef WEFT_KERNELS_BODIES_SLIDING_H
#define WEFT_KERNELS_BODIES_SLIDING_H

// Coulomb's law for a body as a whole. What friction holds of it counts as heavy (holding.h),
// however much that would have to bear. Single vertices do not know: in a few iterations, obstacles
// push some of them by several times what bears the body, and each may grip by as much. Of the
// whole body that is known, as what is too much leads it nowhere (without_throw in moments.h): so
// what is left of the pushes across the surface says how much friction may do along it.

#include "kernels/bodies/moments.h"

WEFT_KERNELS_BEGIN

/// What lies still is held by so much more, so that it does not creep by what pushes are wrong by.
#define WEFT_STATIC_FRICTION 1.03f

typedef struct {
    real slides;    ///< 1; 0: friction holds the body
    real3 rubbing;  ///< what friction does if it slides, in all [m],
    real3 force;    ///< and beyond the pushes
} sliding;

/// kept  what the holding takes of what would lead the body [m]
WEFT_INLINE sliding sliding_of(moments m, borne_lag borne, real3 kept) {
    const real zero = splat(0.0f);
    const real left = splat(1.0f) - borne.share;
    const real3 up = up_of(m);
    const real3 rubbing = scale(along_surface(m.push, up), left);
    const real3 wanted = subtract(rubbing, along_surface(kept, up));
    const real across = larger(dot3(m.push, up), zero) * left;
    const real most = across * m.grip / divisor(length3(m.normal));
    const mask is_held = both(m.hold.part > zero, has_one_side(m));
    const real slides =
        both(is_held, length3(wanted) > most * splat(WEFT_STATIC_FRICTION)) ? splat(1.0f) : zero;
    const real part = most / divisor(length3(wanted));
    const real3 rubbed = scale(wanted, part);
    const sliding s = {slides, rubbed, scale(subtract(rubbed, rubbing), slides)};
    return s;
}

/// A body does not slide where friction leads it to: then it has been pushed too far, and lies. As
/// pushes are wrong by something, it may, by a tenth of what friction does. Where it may by any
/// more, what lies creeps; where it may not at all, what should slide sticks in long steps
/// (docs/measurements.md, "What slides down a slope").
/// slid  how it would move, all in all
WEFT_INLINE sliding against_friction(sliding s, body_motion slid) {
    const real most = splat(0.1f) * dot3(s.rubbing, s.rubbing);
    const real is_against = dot3(slid.shift, s.rubbing) < most ? splat(1.0f) : splat(0.0f);
    const sliding left = {s.slides * is_against, s.rubbing, scale(s.force, is_against)};
    return left;
}

/// The same with its torque about the centre of mass: it acts where the body is held.
WEFT_INLINE body_motion force_of_sliding(moments m, sliding s) {
    const real3 place = scale(m.hold.place, splat(1.0f) / divisor(m.hold.part));
    return make_motion(s.force, cross3(place, s.force));
}

/// What holds the body then: nothing, if it slides.
WEFT_INLINE holding hold_beside(holding h, sliding s) {
    return add_share_of_holding(no_holding(), h, splat(1.0f) - s.slides);
}

WEFT_INLINE body_motion if_it_slides(sliding s, body_motion slid, body_motion held) {
    return add_scaled_motion(add_scaled_motion(no_motion(), held, splat(1.0f) - s.slides), slid,
                             s.slides);
}

WEFT_KERNELS_END

#endif
