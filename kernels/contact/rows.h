#ifndef WEFT_KERNELS_CONTACT_ROWS_H
#define WEFT_KERNELS_CONTACT_ROWS_H

// The contacts of a vertex, as they were found at the substep's begin and stay for the substep:
// normal n away from the other surface, weights w of the four vertices that meet (sum 0), and so a
// gap g(x) = n . sum w_j x_j that is linear in the positions. A contact has a row entry with each
// of its vertices, which all evaluate it themselves.
//
// All contacts of an iteration are seen at a snapshot s of the positions that all vertices share.
// By Cauchy-Schwarz (sum w_j d_j)^2 <= W sum |w_j| d_j^2, W = sum |w_j| of the vertices that move,
// so with c no less than E''
//
//   E(x) <= E(s) + sum_j [ E'(g(s)) w_j n . d_j + c/2 W |w_j| (n . d_j)^2 ],     d_j = x_j - s_j:
//
// each vertex has a gradient and a Hessian block of its own, and whatever the others do meanwhile,
// the energy falls. (The block c w_j^2 alone would be that of one vertex that moves while all
// others stand still: from a snapshot it diverges.)

// Friction needs no more than that. What leads along the surface of r(s) = sum w_j s_j, less what
// did so at the anchors, is how far the two have slid since, and with what they had slid before how
// far they have in all (sticking.h has both in one).

#include "kernels/contact/energy.h"
#include "kernels/contact/friction.h"
#include "kernels/contact/truncation.h"
#include "kernels/descent/rows.h"
#include "kernels/lanes.h"

WEFT_KERNELS_BEGIN

/// One entry of a vertex' row, at a snapshot.
typedef struct {
    real3 normal;
    real3 slip;      ///< of this side along the other one [m]
    real own;        ///< |w| of the vertex
    real spread;     ///< W |w|
    real gap;        ///< [m]
    real ahead;      ///< the gap where inertia leads [m]
    real stiffness;  ///< [N/m]
    real range;      ///< [m]
} contact_entry;

/// Parameters as in gather_contacts.
WEFT_INLINE contact_entry
load_contact(WEFT_GLOBAL const float4* snapshot, WEFT_GLOBAL const int* corner0,
             WEFT_GLOBAL const int* corner1, WEFT_GLOBAL const int* corner2,
             WEFT_GLOBAL const int* corner3, WEFT_GLOBAL const float4* normals,
             WEFT_GLOBAL const float4* weights, WEFT_GLOBAL const float4* measures, integer entry) {
    const real4 n = gather4(normals, entry);
    const real4 w = gather4(weights, entry);
    const real4 m = gather4(measures, entry);
    const real3 s0 = xyz(gather4(snapshot, address(gather_whole(corner0, entry))));
    const real3 s1 = xyz(gather4(snapshot, address(gather_whole(corner1, entry))));
    const real3 s2 = xyz(gather4(snapshot, address(gather_whole(corner2, entry))));
    const real3 s3 = xyz(gather4(snapshot, address(gather_whole(corner3, entry))));
    contact_entry c;
    c.normal = xyz(n);
    c.ahead = n.w;
    const real3 way1 = subtract(s1, s0);
    const real3 way2 = subtract(s2, s0);
    const real3 way3 = subtract(s3, s0);
    c.gap = w.y * dot3(c.normal, way1) + w.z * dot3(c.normal, way2) + w.w * dot3(c.normal, way3);
    const real3 way = add_scaled(add_scaled(scale(way1, w.y), way2, w.z), way3, w.w);
    c.slip = add_scaled(way, c.normal, -c.gap);
    c.own = m.x;
    c.spread = m.y;
    c.stiffness = m.z;
    c.range = m.w;
    return c;
}

/// With the slip that was there when the substep began (sticking.h).
/// slips  [entries] xyz [m]
WEFT_INLINE contact_entry with_earlier_slip(contact_entry c, WEFT_GLOBAL const float4* slips,
                                            integer entry) {
    c.slip = add(c.slip, xyz(gather4(slips, entry)));
    return c;
}

/// Adds what a contact rubs.
/// pull  of both sides per slip: the coefficient times N times f/|u| [N/m]
/// way   of the vertex since the snapshot [m]
WEFT_INLINE derivatives add_rubbing(derivatives s, contact_entry c, real pull, real3 way) {
    const real block = pull * c.spread;
    const real3 along = along_surface(way, c.normal);
    s.gradient = add_scaled(add_scaled(s.gradient, c.slip, pull * c.own), along, block);
    s.hessian = add_sym(s.hessian, add_sym(diagonal_sym(block), outer_sym(c.normal, -block)));
    return s;
}

/// Whether the two sides are near enough. Most entries are there for what might come nearer, so it
/// pays to ask before all else. (Sums that begin with zero never are -0, so adding a zero to them
/// or nothing is the same.)
WEFT_INLINE mask is_pushed(contact_entry c) { return smaller(c.gap, c.ahead) < c.range; }

/// How hard a contact presses, as its gap says [N].
WEFT_INLINE real press_of_gap(contact_entry c) {
    const real slope = contact_slope(c.gap, c.range, c.stiffness);
    return c.gap < c.range ? -slope : splat(0.0f);
}

/// Adds a contact's part of a vertex' gradient and Hessian block, where it is on.
/// way       of the vertex since the snapshot [m]
/// friction  Coulomb coefficient; 0: none
/// creep     the way in a substep below which friction sticks [m]
WEFT_INLINE derivatives add_push(derivatives s, contact_entry c, mask on, real3 way, float friction,
                                 float creep) {
    const mask is_near = is_pushed(c);
    const real slope = contact_slope(c.gap, c.range, c.stiffness);
    const real bound = contact_majorant(c.gap, c.ahead, c.range, c.stiffness);
    const real block = both(on, is_near) ? bound * c.spread : splat(0.0f);
    const real push = both(on, is_near) ? slope * c.own : splat(0.0f);
    s.gradient = add_scaled(s.gradient, c.normal, push + block * dot3(c.normal, way));
    s.hessian = add_sym(s.hessian, outer_sym(c.normal, block));
    if (friction > 0.0f) {
        const real press = both(on, is_near) ? -splat(friction) * slope : splat(0.0f);
        const real grip = friction_grip(length3(c.slip), splat(creep));
        s = add_rubbing(s, c, press * grip, way);
    }
    return s;
}

/// Adds the contacts' part of each vertex' gradient and Hessian block.
/// positions   [vertices] xyz [m]
/// snapshots   [2 * vertices] xyz, of even and of odd iterations [m]
/// vertices    [items] the vertex of each item
/// rows        [2 * vertices] column-major: where the vertex' entries start, room for how many
/// counts      [vertices] how many there are
/// corner0     [entries] the vertices of the contact: corner0 to corner3
/// normals     [entries] xyz: n, away from the other surface; w: the gap where inertia leads [m]
/// weights     [entries] w_j, those of the vertex' side positive
/// measures    [entries] |w| of the vertex, W |w|, stiffness [N/m], range [m]
/// slips       [entries] xyz: those that the substep began with [m] (sticking.h); not read without
///             friction
/// sums        [9 * items] see descent/rows.h
/// friction, creep  as in add_push
WEFT_NARROW_KERNEL(gather_contacts, WEFT_GLOBAL const float4* positions,
                   WEFT_GLOBAL const float4* snapshots, WEFT_GLOBAL const int* vertices,
                   WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* counts,
                   WEFT_GLOBAL const int* corner0, WEFT_GLOBAL const int* corner1,
                   WEFT_GLOBAL const int* corner2, WEFT_GLOBAL const int* corner3,
                   WEFT_GLOBAL const float4* normals, WEFT_GLOBAL const float4* weights,
                   WEFT_GLOBAL const float4* measures, WEFT_GLOBAL const float4* slips,
                   WEFT_GLOBAL float* sums, int item_count, int vertex_count, int iteration,
                   float friction, float creep) {
    const integer vertex = load_index(vertices, i);
    const whole count = gather_whole(counts, vertex);
    const int longest = largest_whole(count);
    if (longest > 0) {
        WEFT_GLOBAL const float4* snapshot = snapshots + vertex_count * (iteration % 2);
        const whole start = gather_whole(rows, vertex);
        const real3 way = subtract(xyz(gather4(positions, vertex)), xyz(gather4(snapshot, vertex)));
        derivatives s = load_derivatives(sums, i, item_count);
        for (int k = 0; k < longest; ++k) {
            const mask on = splat_whole(k) < count;
            const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
            contact_entry c = load_contact(snapshot, corner0, corner1, corner2, corner3, normals,
                                           weights, measures, entry);
            if (!any_item(both(on, is_pushed(c)))) continue;
            if (friction > 0.0f) c = with_earlier_slip(c, slips, entry);
            s = add_push(s, c, on, way, friction, creep);
        }
        store_derivatives(sums, i, item_count, s);
    }
}

/// Lets all see the positions in the next iteration, of those that a contact may have.
/// positions  [vertices] xyz [m], w = 1/mass [1/kg]
/// least      [vertices] as fill_contacts leaves it
/// snapshots  [2 * vertices] written: of odd iterations in the second half
/// ahead      by how many iterations behind this one is that which is to see it
WEFT_KERNEL(take_snapshot, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float* least,
            WEFT_GLOBAL float4* snapshots, int vertex_count, int iteration, int ahead) {
    const mask has_pairs = load(least, i) < splat(WEFT_NO_PLANE);
    if (!any_item(has_pairs)) return;
    store4_where(has_pairs, snapshots, column(i, vertex_count, (iteration + ahead) % 2),
                 load4(positions, i));
}

WEFT_KERNELS_END

#endif
