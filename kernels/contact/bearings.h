#ifndef WEFT_KERNELS_CONTACT_BEARINGS_H
#define WEFT_KERNELS_CONTACT_BEARINGS_H

// How hard the contacts of a free body press, for the friction in the rounds of bodies.h. Their
// gaps hardly say so: what few iterations leave in a contact of a stiff body may be hundreds of
// times its weight, for one round. Nor do xpbd's multipliers, which with few iterations add up to a
// half or a fifth of the weight. But what pushes a body besides inertia is just what leads it
// elsewhere than to x~, in all rounds alike. So single presses only say how that load is shared
// out: they are means over the rounds, corrected so that along their normals they add up to what
// bears the body.
//
// Of a contact's two bodies, the one tells its press that has less of it in all, as the contact is
// a larger part of that. To the other one, such a contact is known, as friction is: a light sheet
// that a block presses on its ground is left with the ground's contacts, which have to bear both.

#include "kernels/lanes.h"
#include "kernels/matrix.h"

WEFT_KERNELS_BEGIN

/// What bears a body. In the tables [2 * rows] column-major, in units of their own: in sums of
/// contacts h^2/M of a force [m], and of a body h^2 of it [kg m].
typedef struct {
    real3 borne;    ///< all that leads it besides inertia and what is known
    real3 pressed;  ///< what the presses are that it has to tell
    real press;     ///< what all are, without their directions
} bearing;

WEFT_INLINE bearing no_bearing(void) {
    const real zero = splat(0.0f);
    const real3 none = make3(zero, zero, zero);
    bearing b = {none, none, zero};
    return b;
}

/// a + b * s
WEFT_INLINE bearing add_scaled_bearing(bearing a, bearing b, real s) {
    a.borne = add_scaled(a.borne, b.borne, s);
    a.pressed = add_scaled(a.pressed, b.pressed, s);
    a.press = a.press + b.press * s;
    return a;
}

WEFT_INLINE bearing gather_bearing(WEFT_GLOBAL const float4* bearings, int rows, integer k) {
    const real4 borne = gather4(bearings, k);
    bearing b = {xyz(borne), xyz(gather4(bearings + rows, k)), borne.w};
    return b;
}

WEFT_INLINE void store_bearing(WEFT_GLOBAL float4* bearings, int rows, item i, bearing b) {
    store4(bearings, i, with_w(b.borne, b.press));
    store4(bearings, column(i, rows, 1), with_w(b.pressed, splat(0.0f)));
}

/// What the presses of a body along a normal have to be multiplied by. Where they hold each other
/// the balance, as those on both sides of what is squeezed, the body's motion says nothing of them;
/// nor do presses that are next to nothing say how a load is shared out, so there is a limit.
WEFT_INLINE real correction_of(bearing b, real3 normal) {
    const real unit = splat(1.0f) / divisor(b.press);
    const real pressed = dot3(b.pressed, normal) * unit;
    const real borne = dot3(b.borne, normal) * unit;
    const real doubt = splat(1e-3f);
    const real correction = (borne * pressed + doubt) / (pressed * pressed + doubt);
    return smaller(larger(correction, splat(0.0f)), splat(16.0f));
}

/// How the press of a contact is told.
typedef struct {
    real part;        ///< that this body has in it: all, none, or half
    real correction;  ///< of the press
} telling;

WEFT_INLINE telling told_by_one(void) {
    telling t = {splat(1.0f), splat(1.0f)};
    return t;
}

/// other  of the body on the other side, if that is free
WEFT_INLINE telling tell(bearing own, bearing other, mask other_is_free, real3 normal) {
    const real one = splat(1.0f);
    const real more = other.press < own.press ? splat(0.0f) : splat(0.5f);
    const real part = own.press < other.press ? one : more;
    telling t = told_by_one();
    t.part = other_is_free ? part : one;
    t.correction =
        correction_of(own, normal) * t.part + correction_of(other, normal) * (one - t.part);
    return t;
}

WEFT_KERNELS_END

#endif
