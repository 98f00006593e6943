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

#define WEFT_BEARING_PARTS 4

WEFT_KERNELS_BEGIN

/// What bears a body. In the tables [4 * rows] column-major, in units of their own: in sums of
/// contacts h^2/M of a force [m], and of a body h^2 of it [kg m].
typedef struct {
    real3 borne;    ///< all that leads it besides inertia and what is known
    real3 pressed;  ///< what the presses are that it has to tell
    real press;     ///< what all are, without their directions
    sym3 spread;    ///< sum of press n n^T of those, n their normals; 0 where not known who tells
} bearing;

WEFT_INLINE bearing no_bearing(void) {
    const real zero = splat(0.0f);
    const real3 none = make3(zero, zero, zero);
    bearing b = {none, none, zero, diagonal_sym(zero)};
    return b;
}

/// a + b * s
WEFT_INLINE bearing add_scaled_bearing(bearing a, bearing b, real s) {
    a.borne = add_scaled(a.borne, b.borne, s);
    a.pressed = add_scaled(a.pressed, b.pressed, s);
    a.press = a.press + b.press * s;
    a.spread = add_sym(a.spread, scale_sym(b.spread, s));
    return a;
}

WEFT_INLINE bearing gather_bearing(WEFT_GLOBAL const float4* bearings, int rows, integer k) {
    const real4 borne = gather4(bearings, k);
    const real4 pressed = gather4(bearings + rows, k);
    const real4 mixed = gather4(bearings + 2 * rows, k);
    const real4 straight = gather4(bearings + 3 * rows, k);
    bearing b = {xyz(borne), xyz(pressed), borne.w,
                 make_sym(straight.x, mixed.x, mixed.y, straight.y, mixed.z, straight.z)};
    return b;
}

WEFT_INLINE void store_bearing(WEFT_GLOBAL float4* bearings, int rows, item i, bearing b) {
    const real zero = splat(0.0f);
    const real3 mixed = make3(b.spread.xy, b.spread.xz, b.spread.yz);
    const real3 straight = make3(b.spread.xx, b.spread.yy, b.spread.zz);
    store4(bearings, i, with_w(b.borne, b.press));
    store4(bearings, column(i, rows, 1), with_w(b.pressed, zero));
    store4(bearings, column(i, rows, 2), with_w(mixed, zero));
    store4(bearings, column(i, rows, 3), with_w(straight, zero));
}

/// What the presses of a body along a normal n have to be multiplied by, such that they add up to
/// what bears it along n: by one factor for all. Where they say that it is pressed the other way,
/// as too hard from above on its ground, there is none, and by 0 it would slide on both sides: the
/// lowest of sheets that lay turned on each other went aside. Of all c with
///
///   sum of press c n = borne
///
/// those for which sum of press (c - 1)^2 is least are 1 + n . l, with one l for all contacts: more
/// on one side, less on the other. Here l is what solves that along n alone. (Where all press on
/// one side along n, both are the same. To take the second for all was tried: a light sheet that a
/// block presses on its ground stayed behind on its slope. So it did where this was done before it
/// is known which contacts others tell.)
///
/// Presses that are next to nothing do not say how a load is shared out, so there is a limit.
/// normal  away from the other side
WEFT_INLINE real correction_of(bearing b, real3 normal) {
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const real unit = one / divisor(b.press);
    const real pressed = dot3(b.pressed, normal) * unit;
    const real borne = dot3(b.borne, normal) * unit;
    const real spread = dot3(multiply_sym(b.spread, normal), normal) * unit;
    const real opposed = zero - borne * pressed;
    const real way = both(opposed > zero, spread > zero) ? spread : pressed;
    const real doubt = splat(1e-3f);
    const real correction = one + (borne - pressed) * way / (way * way + doubt);
    return smaller(larger(correction, zero), splat(16.0f));
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
    t.correction = correction_of(own, normal) * t.part +
                   correction_of(other, scale(normal, splat(-1.0f))) * (one - t.part);
    return t;
}

WEFT_KERNELS_END

#endif
