#ifndef WEFT_KERNELS_NEWTON_CONTACTS_H
#define WEFT_KERNELS_NEWTON_CONTACTS_H

// The contacts' part of the Hessian. With the way d = sum_j w_j p_j between the closest points of a
// contact, and n its normal,
//   (H p)_v = w_v [ c n (n . d) + g (d - n (n . d)) ]
// where c is the curvature of its energy and g the force by which it rubs per slip; so it is
// positive, and the same for all four vertices, which each compute it themselves.

#include "kernels/contact/rows.h"
#include "kernels/newton/blocks.h"

WEFT_KERNELS_BEGIN

/// What the contacts have at these positions.
/// curvatures  [entries] written: c [N/m], 0 beyond the range
/// grips       [entries] written: g [N/m]
/// others as in gather_contacts (contact/rows.h)
WEFT_NARROW_KERNEL(couple_contacts, WEFT_GLOBAL const float4* positions,
                   WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* counts,
                   WEFT_GLOBAL const int* corner0, WEFT_GLOBAL const int* corner1,
                   WEFT_GLOBAL const int* corner2, WEFT_GLOBAL const int* corner3,
                   WEFT_GLOBAL const float4* normals, WEFT_GLOBAL const float4* weights,
                   WEFT_GLOBAL const float4* measures, WEFT_GLOBAL const float4* slips,
                   WEFT_GLOBAL float* curvatures, WEFT_GLOBAL float* grips, float friction,
                   float creep) {
    const whole count = load_whole(counts, i);
    const whole start = load_whole(rows, i);
    const int longest = largest_whole(count);
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
        contact_entry c = load_contact(positions, corner0, corner1, corner2, corner3, normals,
                                       weights, measures, entry);
        if (friction > 0.0f) c = with_earlier_slip(c, slips, entry);
        const real curvature = contact_curvature(c.gap, c.range, c.stiffness);
        const real press = -splat(friction) * contact_slope(c.gap, c.range, c.stiffness);
        scatter_where(on, curvatures, entry, c.gap < c.range ? curvature : splat(0.0f));
        scatter_where(on, grips, entry, press * friction_grip(length3(c.slip), splat(creep)));
    }
}

/// products += H p of the contacts.
/// directions  [vertices] xyz: p
/// products    [3 * vertices] column-major, see blocks.h
/// others as in couple_contacts
WEFT_NARROW_KERNEL(multiply_contacts, WEFT_GLOBAL const float4* directions,
                   WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* counts,
                   WEFT_GLOBAL const int* corner0, WEFT_GLOBAL const int* corner1,
                   WEFT_GLOBAL const int* corner2, WEFT_GLOBAL const int* corner3,
                   WEFT_GLOBAL const float4* normals, WEFT_GLOBAL const float4* weights,
                   WEFT_GLOBAL const float4* measures, WEFT_GLOBAL const float* curvatures,
                   WEFT_GLOBAL const float* grips, WEFT_GLOBAL float* products, int vertex_count) {
    const whole count = load_whole(counts, i);
    const whole start = load_whole(rows, i);
    const int longest = largest_whole(count);
    if (longest > 0) {
        const real zero = splat(0.0f);
        real3 sum = load_product(products, i, vertex_count, 0);
        for (int k = 0; k < longest; ++k) {
            const mask on = splat_whole(k) < count;
            const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
            const real curvature = gather(curvatures, entry);
            const real grip = gather(grips, entry);
            // Most are not pushed; see is_pushed().
            if (!any_item(both(on, larger(curvature, grip) > zero))) continue;
            const contact_entry c = load_contact(directions, corner0, corner1, corner2, corner3,
                                                 normals, weights, measures, entry);
            const real own = on ? c.own : zero;
            sum = add_scaled(sum, c.normal, own * (curvature * c.gap));
            sum = add_scaled(sum, c.slip, own * grip);
        }
        store_product(products, i, vertex_count, sum);
    }
}

WEFT_KERNELS_END

#endif
