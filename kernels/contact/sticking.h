#ifndef WEFT_KERNELS_CONTACT_STICKING_H
#define WEFT_KERNELS_CONTACT_STICKING_H

// What sticks stays where it is. Friction is the slope of a potential of the slip (friction.h). If
// the slip counted from each substep's begin, whatever is pulled along a surface would creep in
// every one of them. So slips are kept over substeps, as far as friction can hold them: at a
// substep's end what is beyond the creep e has slid for good (the return mapping of elastic and
// plastic slip, Simo and Laursen 1992).
//
// Contacts are found anew in each substep, so vertices keep slips, not contacts: each as much as
// its contacts say on average, weighted by how they (nearly) press, and of each contact its part,
// such that the parts of all its vertices that move add up to the slip. A vertex of cloth is rubbed
// on both sides and keeps a slip for each: on the side of a reference r, and on the other one.

#include "kernels/contact/rows.h"

/// By how much of their range contacts may be open and yet keep their slips. After a few iterations
/// what presses comes and goes from substep to substep; who forgot slips on that would creep.
#define WEFT_STICKING_GAP 0.01f

WEFT_KERNELS_BEGIN

/// What a vertex keeps of its slip along the surface that it is pushed away from, along `away`.
/// kept, vertex_count  as in keep_slips
WEFT_INLINE real3 kept_slip(WEFT_GLOBAL const float4* kept, int vertex_count, integer vertex,
                            real3 away) {
    const real3 reference = xyz(gather4(kept, vertex));
    const real3 there = xyz(gather4(kept + vertex_count, vertex));
    const real3 beyond = xyz(gather4(kept + 2 * vertex_count, vertex));
    const mask is_there = dot3(reference, away) >= splat(0.0f);
    return make3(is_there ? there.x : beyond.x, is_there ? there.y : beyond.y,
                 is_there ? there.z : beyond.z);
}

/// A vertex' part of a contact's slip. w: its weight
WEFT_INLINE real3 weighted_slip(WEFT_GLOBAL const float4* kept, int vertex_count, integer vertex,
                                real3 normal, real w) {
    const real side = w < splat(0.0f) ? splat(-1.0f) : splat(1.0f);
    return scale(kept_slip(kept, vertex_count, vertex, scale(normal, side)), w);
}

/// With which slips the contacts of a substep begin. Over all vertices, behind fill_contacts.
/// anchors  [vertices] xyz: where contacts were found [m]. Those of which the closest points are
///          taken from where inertia leads have slid, as rows.h counts it, by that already; so that
///          is taken off.
/// slips    [entries] xyz, written: of this side along the other one [m]
/// others as in keep_slips
WEFT_NARROW_KERNEL(recall_slips, WEFT_GLOBAL const float4* anchors, WEFT_GLOBAL const float4* kept,
                   WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* counts,
                   WEFT_GLOBAL const int* corner0, WEFT_GLOBAL const int* corner1,
                   WEFT_GLOBAL const int* corner2, WEFT_GLOBAL const int* corner3,
                   WEFT_GLOBAL const float4* normals, WEFT_GLOBAL const float4* weights,
                   WEFT_GLOBAL const float4* measures, WEFT_GLOBAL float4* slips,
                   int vertex_count) {
    const whole start = load_whole(rows, i);
    const whole count = load_whole(counts, i);
    const int longest = largest_whole(count);
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
        const contact_entry there = load_contact(anchors, corner0, corner1, corner2, corner3,
                                                 normals, weights, measures, entry);
        const real3 n = there.normal;
        const real4 w = gather4(weights, entry);
        const integer c0 = address(gather_whole(corner0, entry));
        const integer c1 = address(gather_whole(corner1, entry));
        const integer c2 = address(gather_whole(corner2, entry));
        const integer c3 = address(gather_whole(corner3, entry));
        const real3 sum = add(add(weighted_slip(kept, vertex_count, c0, n, w.x),
                                  weighted_slip(kept, vertex_count, c1, n, w.y)),
                              add(weighted_slip(kept, vertex_count, c2, n, w.z),
                                  weighted_slip(kept, vertex_count, c3, n, w.w)));
        scatter4_where(on, slips, entry,
                       with_w(subtract(along_surface(sum, n), there.slip), splat(0.0f)));
    }
}

/// The slips of a vertex' contacts on one side of it, each weighted.
typedef struct {
    real3 sum;
    real weight;
} slip_sum;

WEFT_INLINE slip_sum add_slip(slip_sum s, real3 slip, real weight) {
    s.sum = add_scaled(s.sum, slip, weight);
    s.weight = s.weight + weight;
    return s;
}

WEFT_INLINE real4 mean_slip(slip_sum s) {
    const real zero = splat(0.0f);
    const real share = s.weight > zero ? splat(1.0f) / s.weight : zero;
    return with_w(scale(s.sum, share), zero);
}

/// What stays of slips. Over all vertices, where a substep ends.
/// positions  [vertices] xyz [m]
/// slips      [entries] as recall_slips leaves them
/// kept       [3 * vertices] xyz, written, column-major: the reference r, of length 1 or 0; the
///            slip that is kept on its side, and on the other one [m]
/// creep      e [m] > 0
/// others as in gather_contacts (rows.h)
WEFT_NARROW_KERNEL(keep_slips, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* rows,
                   WEFT_GLOBAL const int* counts, WEFT_GLOBAL const int* corner0,
                   WEFT_GLOBAL const int* corner1, WEFT_GLOBAL const int* corner2,
                   WEFT_GLOBAL const int* corner3, WEFT_GLOBAL const float4* normals,
                   WEFT_GLOBAL const float4* weights, WEFT_GLOBAL const float4* measures,
                   WEFT_GLOBAL const float4* slips, WEFT_GLOBAL float4* kept, int vertex_count,
                   float creep) {
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const real3 nothing = make3(zero, zero, zero);
    const whole start = load_whole(rows, i);
    const whole count = load_whole(counts, i);
    const int longest = largest_whole(count);
    real3 reference = nothing;
    slip_sum there = {nothing, zero};
    slip_sum beyond = there;
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
        contact_entry c = load_contact(positions, corner0, corner1, corner2, corner3, normals,
                                       weights, measures, entry);
        c = with_earlier_slip(c, slips, entry);
        const real gap = c.gap - splat(WEFT_STICKING_GAP) * c.range;
        const real slope = contact_slope(gap, c.range, c.stiffness);
        const real press = on ? -slope * c.own : zero;
        // The part of one whose weight is W of all that move, and no more than sticks.
        const real part = on ? c.own / c.spread : zero;
        const real held = smaller(splat(creep) / larger(length3(c.slip), splat(creep)), one);
        const real3 slip = scale(c.slip, part * held);
        const mask is_first = both(press > zero, there.weight + beyond.weight <= zero);
        reference = make3(is_first ? c.normal.x : reference.x, is_first ? c.normal.y : reference.y,
                          is_first ? c.normal.z : reference.z);
        const mask is_there = dot3(reference, c.normal) >= zero;
        there = add_slip(there, slip, is_there ? press : zero);
        beyond = add_slip(beyond, slip, is_there ? zero : press);
    }
    store4(kept, i, with_w(reference, zero));
    store4(kept, column(i, vertex_count, 1), mean_slip(there));
    store4(kept, column(i, vertex_count, 2), mean_slip(beyond));
}

WEFT_KERNELS_END

#endif
