#ifndef WEFT_KERNELS_CONTACT_PUSHES_H
#define WEFT_KERNELS_CONTACT_PUSHES_H

// What pushes a free body as a whole. Rows of contacts are made for vertices: each has its own
// entry, which names four corners anywhere. The rounds of bodies.h see no single vertices, and walk
// all contacts of a body a dozen times. So they are collected once per substep: a contact once for
// the whole side that the body has of it, for the column in which the first vertex of that side is
// summed, with what it says at the positions at hand. How far bodies have gone since is all that a
// round has to know besides.

#include "kernels/bodies/runs.h"
#include "kernels/contact/codes.h"
#include "kernels/contact/resting.h"
#include "kernels/contact/rows.h"

WEFT_KERNELS_BEGIN

/// The one of a contact's vertices on this side that stands for all of them: the first one that
/// has a weight.
WEFT_INLINE whole first_of_side(real4 w, whole c0, whole c1, whole c2, whole c3) {
    const real zero = splat(0.0f);
    return w.x > zero ? c0 : (w.y > zero ? c1 : (w.z > zero ? c2 : c3));
}

/// What the vertices on this side weigh together.
WEFT_INLINE real weight_of_side(real4 w) {
    const real zero = splat(0.0f);
    return (larger(w.x, zero) + larger(w.y, zero)) + (larger(w.z, zero) + larger(w.w, zero));
}

/// Where a contact touches one side: its vertices have weights of this sign.
/// positions  [vertices] xyz [m]
/// total      what they weigh together, without the sign
WEFT_INLINE real3 point_of_side(WEFT_GLOBAL const float4* positions, real4 w, real total,
                                float sign, whole c0, whole c1, whole c2, whole c3) {
    const real zero = splat(0.0f);
    const real unit = splat(sign) / total;
    const real3 x0 = scale(xyz(gather4(positions, address(c0))), larger(w.x * unit, zero));
    const real3 x1 = add_scaled(x0, xyz(gather4(positions, address(c1))), larger(w.y * unit, zero));
    const real3 x2 = add_scaled(x1, xyz(gather4(positions, address(c2))), larger(w.z * unit, zero));
    return add_scaled(x2, xyz(gather4(positions, address(c3))), larger(w.w * unit, zero));
}

/// x~ - x [m]
WEFT_INLINE real3 lag_of_vertex(WEFT_GLOBAL const float4* positions,
                                WEFT_GLOBAL const float4* targets, integer vertex) {
    return subtract(xyz(gather4(targets, vertex)), xyz(gather4(positions, vertex)));
}

/// For each column of a free body's vertices the contacts that they have with others.
/// positions    [vertices] xyz [m], where contacts are seen
/// targets      [vertices] xyz: x~ [m]
/// members, shares, column_rows  of the columns: see bodies/runs.h
/// bodies       [vertices] which of the free bodies each belongs to; `body_count`: to none
/// leaders      [substeps * level_count * bodies] the first one of each body's group, level by level
///              (groups.h)
/// rows, counts, corner0 to corner3, normals, weights, measures  as in gather_contacts
/// push_rows, push_counts, push_needs   of the columns, written; see runtime/row_table.h
/// codes        [entries] written: of the body on the other side, and of the number of levels on
///              which that is of this body's group (codes.h)
/// sides        [entries] written: n; the gap [m]
/// slips        [entries] written: of this side along the other one [m]; the gap where inertia
///              leads [m]
/// earlier_slips  [entries] as the slips of gather_contacts
/// multipliers  [entries] of xpbd, see project_contacts [N s^2]; not read where has_multipliers is 0
/// inverse_h2   1 / h^2 [1/s^2], h the substep
/// forces       [entries] written: |w| and W |w| of the whole side; stiffness [N/m]; range [m]
/// points, other_points  [entries] written: where this side is touched, and the other one [m]; of
///              two free bodies the middle between, so that forces on both, also those along
///              surfaces, turn nothing that they have in common; w of the first: WEFT_RESTS_NOT
/// presses      [entries] written with friction: how hard they press each other, as multipliers or
///              gaps say [N]
/// standing     [columns] written: the sum of shares times x~ - x [m]; of shares
WEFT_NARROW_KERNEL(collect_pushes, WEFT_GLOBAL const float4* positions,
                   WEFT_GLOBAL const float4* targets, WEFT_GLOBAL const int* members,
                   WEFT_GLOBAL const float* shares, WEFT_GLOBAL const int* column_rows,
                   WEFT_GLOBAL const int* bodies, WEFT_GLOBAL const int* leaders,
                   WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* counts,
                   WEFT_GLOBAL const int* corner0, WEFT_GLOBAL const int* corner1,
                   WEFT_GLOBAL const int* corner2, WEFT_GLOBAL const int* corner3,
                   WEFT_GLOBAL const float4* normals, WEFT_GLOBAL const float4* weights,
                   WEFT_GLOBAL const float4* measures, WEFT_GLOBAL const float4* earlier_slips,
                   WEFT_GLOBAL const float* multipliers, WEFT_GLOBAL const int* push_rows,
                   WEFT_GLOBAL int* push_counts, WEFT_GLOBAL int* push_needs,
                   WEFT_GLOBAL int* codes, WEFT_GLOBAL float4* sides, WEFT_GLOBAL float4* slips,
                   WEFT_GLOBAL float4* forces, WEFT_GLOBAL float4* points,
                   WEFT_GLOBAL float4* other_points, WEFT_GLOBAL float* presses,
                   WEFT_GLOBAL float4* standing, int column_count, int body_count, int level_count,
                   float friction, int has_multipliers, float inverse_h2, int instance) {
    const real zero = splat(0.0f);
    const whole none = splat_whole(0);
    const whole last_body = splat_whole(body_count - 1);
    WEFT_GLOBAL const int* group_leaders = leaders + instance * level_count * body_count;
    const whole push_start = load_whole(push_rows, i);
    const whole room = load_whole(push_rows, column(i, column_count, 1));
    whole found = none;
    real3 lag = make3(zero, zero, zero);
    real part = zero;
    const int length = column_rows[2 * i.first + 1];
    for (int k = 0; k < length; ++k) {
        const item member = {column_rows[2 * i.first] + WEFT_RUN_COLUMNS * k, i.count};
        const whole vertex = load_whole(members, member);
        const real share = load(shares, member);
        lag = add_scaled(lag, lag_of_vertex(positions, targets, address(vertex)), share);
        part = part + share;

        const whole own_body = gather_whole(bodies, address(vertex));
        const whole start = gather_whole(rows, address(vertex));
        const whole listed = gather_whole(counts, address(vertex));
        const whole count = share > zero ? listed : none;
        const int longest = largest_whole(count);
        for (int n = 0; n < longest; ++n) {
            const mask on = splat_whole(n) < count;
            const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * n) : start);
            const whole c0 = gather_whole(corner0, entry);
            const whole c1 = gather_whole(corner1, entry);
            const whole c2 = gather_whole(corner2, entry);
            const whole c3 = gather_whole(corner3, entry);
            const real4 w = gather4(weights, entry);
            // The first vertex and the last one are never on one side.
            const whole one_side = gather_whole(bodies, address(c0));
            const whole other_side = gather_whole(bodies, address(c3));
            const whole first = first_of_side(w, c0, c1, c2, c3);
            const mask counts_here = both(both(on, one_side != other_side), first == vertex);
            if (any_item(counts_here)) {
                contact_entry c = load_contact(positions, corner0, corner1, corner2, corner3,
                                               normals, weights, measures, entry);
                if (friction > 0.0f) c = with_earlier_slip(c, earlier_slips, entry);
                const whole opposite = one_side == own_body ? other_side : one_side;
                const mask is_free = opposite < splat_whole(body_count);
                whole code = code_of_body(opposite);
                for (int level = 0; level < level_count; ++level) {
                    WEFT_GLOBAL const int* first_of = group_leaders + level * body_count;
                    const whole own_leader =
                        gather_whole(first_of, address(smaller_whole(own_body, last_body)));
                    const whole leader =
                        gather_whole(first_of, address(smaller_whole(opposite, last_body)));
                    const mask is_inside = both(is_free, leader == own_leader);
                    code = is_inside ? code + splat_whole(1) : code;
                }
                const real own = weight_of_side(w);
                // The weights of both sides are the same.
                const real3 here = point_of_side(positions, w, own, 1.0f, c0, c1, c2, c3);
                const real3 there = point_of_side(positions, w, own, -1.0f, c0, c1, c2, c3);
                const real inward = is_free ? splat(0.5f) : zero;
                const real3 between = scale(subtract(there, here), inward);
                const real3 point = add(here, between);
                const real3 other_point = subtract(there, between);
                const real4 force = {own, c.spread * (own / c.own), c.stiffness, c.range};
                const mask fits = both(counts_here, found < room);
                const integer place = address(push_start + found * WEFT_ROW_STRIDE);
                scatter_whole_where(fits, codes, place, code);
                scatter4_where(fits, sides, place, with_w(c.normal, c.gap));
                scatter4_where(fits, slips, place, with_w(c.slip, c.ahead));
                scatter4_where(fits, forces, place, force);
                scatter4_where(fits, points, place, with_w(point, splat(WEFT_RESTS_NOT)));
                scatter4_where(fits, other_points, place, with_w(other_point, zero));
                if (friction > 0.0f) {
                    const real press = has_multipliers
                                           ? gather(multipliers, entry) * splat(inverse_h2)
                                           : press_of_gap(c);
                    scatter_where(fits, presses, place, press);
                }
                found = counts_here ? found + splat_whole(1) : found;
            }
        }
    }
    store4(standing, i, with_w(lag, part));
    store_whole(push_counts, i, smaller_whole(found, room));
    store_whole(push_needs, i,
                instance == 0 ? found : larger_whole(found, load_whole(push_needs, i)));
}

/// Likewise where there are no contacts.
WEFT_KERNEL(collect_no_pushes, WEFT_GLOBAL const float4* positions,
            WEFT_GLOBAL const float4* targets, WEFT_GLOBAL const int* members,
            WEFT_GLOBAL const float* shares, WEFT_GLOBAL const int* column_rows,
            WEFT_GLOBAL int* push_counts, WEFT_GLOBAL int* push_needs, WEFT_GLOBAL float4* standing,
            int instance) {
    const whole none = splat_whole(0);
    const real zero = splat(0.0f);
    real3 lag = make3(zero, zero, zero);
    real part = zero;
    const int length = column_rows[2 * i.first + 1];
    for (int k = 0; k < length; ++k) {
        const item member = {column_rows[2 * i.first] + WEFT_RUN_COLUMNS * k, i.count};
        const real share = load(shares, member);
        lag =
            add_scaled(lag, lag_of_vertex(positions, targets, load_index(members, member)), share);
        part = part + share;
    }
    store4(standing, i, with_w(lag, part));
    store_whole(push_counts, i, none);
    store_whole(push_needs, i, instance == 0 ? none : load_whole(push_needs, i));
}

/// One entry of a column's row: a contact of the whole side.
WEFT_INLINE contact_entry load_push(WEFT_GLOBAL const float4* sides,
                                    WEFT_GLOBAL const float4* slips,
                                    WEFT_GLOBAL const float4* forces, integer entry) {
    const real4 side = gather4(sides, entry);
    const real4 slip = gather4(slips, entry);
    const real4 force = gather4(forces, entry);
    contact_entry c;
    c.normal = xyz(side);
    c.gap = side.w;
    c.slip = xyz(slip);
    c.ahead = slip.w;
    c.own = force.x;
    c.spread = force.y;
    c.stiffness = force.z;
    c.range = force.w;
    return c;
}

/// Where its side has gone on by a way past the other one.
WEFT_INLINE contact_entry moved_push(contact_entry c, real3 way) {
    c.gap = c.gap + dot3(way, c.normal);
    c.slip = add(c.slip, along_surface(way, c.normal));
    c.ahead = c.range;
    return c;
}

WEFT_KERNELS_END

#endif
