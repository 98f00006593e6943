#ifndef WEFT_KERNELS_BODIES_HOLDING_H
#define WEFT_KERNELS_BODIES_HOLDING_H

// What friction on obstacles holds of a free body. It holds single vertices, as far as these are
// pressed, and has the last word behind the step of the body as a whole: what that has led away, it
// brings back vertex by vertex, and so it strains the body. The step had better go round what is
// held: a block that tips over turns about its edge.

#include "kernels/bodies/motions.h"
#include "kernels/obstacles/grip.h"

WEFT_KERNELS_BEGIN

/// So many times heavier than it is counts what is held. With 10 blocks creep where they should not
/// (docs/measurements.md, "What obstacles bear").
#define WEFT_HELD_WEIGHT 30.0f

/// In parts of the body's mass, with r from a place that is the same for all of the body.
typedef struct {
    real part;    ///< how much of it is held
    real3 place;  ///< mean of r there [m]
    sym3 spread;  ///< of r r^T [m^2]
} holding;

WEFT_INLINE holding no_holding(void) {
    const real zero = splat(0.0f);
    holding h = {zero, make3(zero, zero, zero), diagonal_sym(zero)};
    return h;
}

/// Of one vertex. What slides leaves nothing of its grip but rounding.
/// spread  r r^T [m^2]
/// grip    what friction may still take back (obstacles/grip.h) [m]
/// push    how far obstacles have pushed the vertex [m]
/// part    1, or 0: of a body for which this does not count
WEFT_INLINE holding holding_at(real3 r, sym3 spread, real grip, real push, real part) {
    const real held = grip > larger(push * splat(1e-3f), splat(WEFT_NO_GRIP)) ? part : splat(0.0f);
    holding h = {held, scale(r, held), scale_sym(spread, held)};
    return h;
}

/// 1, or 0 where nothing is held.
WEFT_INLINE real is_held(holding h) { return h.part > splat(0.0f) ? splat(1.0f) : splat(0.0f); }

WEFT_INLINE holding add_share_of_holding(holding a, holding b, real share) {
    a.part = a.part + b.part * share;
    a.place = add_scaled(a.place, b.place, share);
    a.spread = add_sym(a.spread, scale_sym(b.spread, share));
    return a;
}

/// The same from another place, from which the own one is at a lever.
WEFT_INLINE holding holding_from(holding h, real3 lever) {
    const mat3 m = outer_mat(h.place, lever);
    const sym3 both_ways = make_sym(m.x.x + m.x.x, m.x.y + m.y.x, m.x.z + m.z.x, m.y.y + m.y.y,
                                    m.y.z + m.z.y, m.z.z + m.z.z);
    h.spread = add_sym(add_sym(h.spread, both_ways), outer_sym(lever, h.part));
    h.place = add_scaled(h.place, lever, h.part);
    return h;
}

/// The form of motions, of the ways of what is there.
WEFT_INLINE sym6 form_of_places(holding h) {
    const sym3 turned = scale_sym(h.spread, splat(-1.0f));
    const sym6 a = {diagonal_sym(h.part), lever_mat(h.place),
                    add_diagonal(turned, trace_sym(h.spread))};
    return a;
}

/// What motions have to overcome there, beside the body's inertia.
WEFT_INLINE sym6 form_of_holding(holding h) {
    return add_scaled_sym6(no_sym6(), form_of_places(h), splat(WEFT_HELD_WEIGHT));
}

WEFT_KERNELS_END

#endif
