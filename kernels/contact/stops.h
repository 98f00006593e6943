#ifndef WEFT_KERNELS_CONTACT_STOPS_H
#define WEFT_KERNELS_CONTACT_STOPS_H

// Solids that come fast at what does not give way: within a substep they would go through the
// planes of truncation.h, which take back single vertices. Of a stiff block the lowest ones stood
// there while the rest came on, with hundreds of times the energy of its fall. So to the rounds of
// bodies.h such a plane is hard, as convex obstacles are (resting.h), and the solid stops as a
// whole. Who does not come that fast has no such entries.
//
// A plane gives no momentum to what is behind it, so that is for groups of which something is held,
// or lies on an obstacle: others' planes move with them (begin.h).

#include "kernels/contact/resting.h"
#include "kernels/contact/truncation.h"

WEFT_KERNELS_BEGIN

/// Adds an entry for each vertex of a column's body that inertia leads through planes: for the one
/// that it leads it through farthest. Behind the other entries of the column (pushes.h).
/// positions  [vertices] xyz [m]
/// targets    [vertices] xyz: x~ [m]
/// anchors, least, rows, counts, planes  as in truncate_contacts
/// hardness   [vertices] k of those that stop as wholes, 0 of others [N/m]
/// scene_bodies  [vertices] which of the scene's bodies each belongs to
/// are_borne  [substeps * scene_body_count] 1: of a group that does not give way; else 0
/// members to presses  as in collect_resting
/// soft       what stays between plane and vertex [m]
WEFT_NARROW_KERNEL(collect_stops, WEFT_GLOBAL const float4* positions,
                   WEFT_GLOBAL const float4* targets, WEFT_GLOBAL const float4* anchors,
                   WEFT_GLOBAL const float* least, WEFT_GLOBAL const int* rows,
                   WEFT_GLOBAL const int* counts, WEFT_GLOBAL const float4* planes,
                   WEFT_GLOBAL const float* hardness, WEFT_GLOBAL const int* scene_bodies,
                   WEFT_GLOBAL const float* are_borne, WEFT_GLOBAL const int* members,
                   WEFT_GLOBAL const float* shares, WEFT_GLOBAL const int* column_rows,
                   WEFT_GLOBAL const int* push_rows, WEFT_GLOBAL int* push_counts,
                   WEFT_GLOBAL int* push_needs, WEFT_GLOBAL int* codes, WEFT_GLOBAL float4* sides,
                   WEFT_GLOBAL float4* slips, WEFT_GLOBAL float4* forces,
                   WEFT_GLOBAL float4* points, WEFT_GLOBAL float4* other_points,
                   WEFT_GLOBAL float* presses, int column_count, int body_count,
                   int scene_body_count, float soft, int instance) {
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    WEFT_GLOBAL const float* borne = are_borne + scene_body_count * instance;
    const whole push_start = load_whole(push_rows, i);
    const whole room = load_whole(push_rows, column(i, column_count, 1));
    whole found = load_whole(push_counts, i);
    const int length = column_rows[2 * i.first + 1];
    for (int k = 0; k < length; ++k) {
        const item member = {column_rows[2 * i.first] + WEFT_RUN_COLUMNS * k, i.count};
        const integer vertex = load_index(members, member);
        const real hard =
            gather(hardness, vertex) * gather(borne, address(gather_whole(scene_bodies, vertex)));
        const mask stops = load(shares, member) * hard > zero;
        const mask on = both(stops, gather(least, vertex) < splat(WEFT_NO_PLANE));
        if (!any_item(on)) continue;
        const real3 x = xyz(gather4(positions, vertex));
        const real3 anchor = xyz(gather4(anchors, vertex));
        const real3 wanted = subtract(xyz(gather4(targets, vertex)), anchor);
        const whole start = gather_whole(rows, vertex);
        const whole listed = gather_whole(counts, vertex);
        const whole count = on ? listed : splat_whole(0);
        const int longest = largest_whole(count);
        real farthest = zero;
        real gap = zero;
        real3 normal = make3(zero, zero, zero);
        for (int n = 0; n < longest; ++n) {
            const mask is_listed = splat_whole(n) < count;
            const whole here = start + splat_whole(WEFT_ROW_STRIDE * n);
            const real4 plane = gather4(planes, address(is_listed ? here : start));
            const real before = room_before(plane.w, splat(soft));
            const real ahead = dot3(wanted, xyz(plane)) + before;
            const mask is_farthest = both(is_listed, ahead < farthest);
            const real now = dot3(subtract(x, anchor), xyz(plane)) + before;
            farthest = is_farthest ? ahead : farthest;
            gap = is_farthest ? now : gap;
            normal.x = is_farthest ? plane.x : normal.x;
            normal.y = is_farthest ? plane.y : normal.y;
            normal.z = is_farthest ? plane.z : normal.z;
        }
        const mask leads_through = farthest < zero;
        const mask fits = both(leads_through, found < room);
        const integer place = address(push_start + found * WEFT_ROW_STRIDE);
        const real4 force = {one, one, hard, one};
        scatter_whole_where(fits, codes, place, code_of_body(splat_whole(body_count)));
        scatter4_where(fits, sides, place, with_w(normal, gap));
        scatter4_where(fits, slips, place, with_w(make3(zero, zero, zero), one));
        scatter4_where(fits, forces, place, force);
        scatter4_where(fits, points, place, with_w(x, zero));
        scatter4_where(fits, other_points, place, with_w(x, zero));
        scatter_where(fits, presses, place, zero);
        found = leads_through ? found + splat_whole(1) : found;
    }
    store_whole(push_counts, i, smaller_whole(found, room));
    store_whole(push_needs, i, larger_whole(found, load_whole(push_needs, i)));
}

WEFT_KERNELS_END

#endif
