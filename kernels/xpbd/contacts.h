#ifndef WEFT_KERNELS_XPBD_CONTACTS_H
#define WEFT_KERNELS_XPBD_CONTACTS_H

// Contacts as constraints: the multiplier l of each is to become -h^2 E'(g), E being the energy of
// all solvers (contact/energy.h), so l >= 0, and 0 where the gap g is beyond the range. While
// E is a parabola, that is a constraint g - range >= 0 with compliance 1/k (Macklin, Mueller and
// Chentanez 2016); further in, a step of Newton's method for l stands in its place. It never goes
// too far in from too few: E' is concave.
//
// What presses by l holds back what slides along it by as much as mu l: that is a projection of its
// own behind it.
//
// All contacts are projected at once, from positions that all vertices share. So that those of one
// vertex do not do its work several times over, each gets a part of its mass (Tonge, Benevolenski
// and Voroshilov 2012), in proportion to its weight |w| there: for a contact of weight w the vertex
// is S / |w| times as light, S being the sum of |w| over its contacts. In the first iteration that
// is all of them, in others those that pressed in the one before: what does not press leaves the
// mass to what does. (To count in the first iteration what presses where inertia leads was tried:
// where more came to press, it was pushed too far, and stacks crept.) All vertices of a contact
// compute the same change of its multiplier, from the same numbers in the same order, so what one
// of them gets, the others give.

#include "kernels/contact/rows.h"

WEFT_KERNELS_BEGIN

/// S of the first iteration. Parameters as in project_contacts.
WEFT_INLINE real crowd_of(WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* counts,
                          WEFT_GLOBAL const float4* measures, item i) {
    const whole count = load_whole(counts, i);
    const whole start = load_whole(rows, i);
    const int longest = largest_whole(count);
    real crowd = splat(0.0f);
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
        crowd = on ? crowd + gather4(measures, entry).x : crowd;
    }
    return crowd;
}

/// Lets all see where the elements have led the vertices that a contact may have.
/// positions  [vertices] xyz [m], w = 1/mass [1/kg]
/// least      [vertices] as fill_contacts leaves it
/// snapshots  [2 * vertices] written: of odd iterations in the second half; w = S/mass [1/kg], but
///            for the first iteration as project_contacts left it
/// ahead      by how many iterations behind this one is that which is to see it
/// others as in project_contacts
WEFT_NARROW_KERNEL(share_masses, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* rows,
                   WEFT_GLOBAL const int* counts, WEFT_GLOBAL const float4* measures,
                   WEFT_GLOBAL const float* least, WEFT_GLOBAL float4* snapshots, int vertex_count,
                   int iteration, int ahead) {
    const mask has_pairs = load(least, i) < splat(WEFT_NO_PLANE);
    if (!any_item(has_pairs)) return;
    const item shown = column(i, vertex_count, (iteration + ahead) % 2);
    const real4 x = load4(positions, i);
    const real light =
        iteration == 0 ? x.w * crowd_of(rows, counts, measures, i) : load4(snapshots, shown).w;
    store4_where(has_pairs, snapshots, shown, with_w(xyz(x), light));
}

/// How light a contact's vertices are together, with the parts of their masses that it has: the sum
/// of |w_j| S_j / mass_j [1/kg]. Parameters as in project_contacts.
WEFT_INLINE real lightness_of(WEFT_GLOBAL const float4* snapshot, WEFT_GLOBAL const int* corner0,
                              WEFT_GLOBAL const int* corner1, WEFT_GLOBAL const int* corner2,
                              WEFT_GLOBAL const int* corner3, WEFT_GLOBAL const float4* weights,
                              integer entry) {
    const real4 w = gather4(weights, entry);
    const real light0 = gather4(snapshot, address(gather_whole(corner0, entry))).w;
    const real light1 = gather4(snapshot, address(gather_whole(corner1, entry))).w;
    const real light2 = gather4(snapshot, address(gather_whole(corner2, entry))).w;
    const real light3 = gather4(snapshot, address(gather_whole(corner3, entry))).w;
    return size_of(w.x) * light0 + size_of(w.y) * light1 + size_of(w.z) * light2 +
           size_of(w.w) * light3;
}

/// By how much the multiplier of a contact changes.
/// lightness  the sum of |w_j| S_j / mass_j [1/kg]
WEFT_INLINE real change_of_multiplier(contact_entry c, real multiplier, real lightness,
                                      float inverse_h2) {
    const real lack = multiplier * splat(inverse_h2) + contact_slope(c.gap, c.range, c.stiffness);
    const real curvature = contact_curvature(c.gap, c.range, c.stiffness);
    const real change = -lack / (splat(inverse_h2) + curvature * lightness);
    return larger(change, -multiplier);
}

/// Pushes vertices apart. Over all vertices.
/// positions    [vertices] xyz [m], w = 1/mass [1/kg]; written where there are contacts
/// snapshots    [2 * vertices] as share_masses leaves them; written: w of the next iteration, S no
///              less than 1, as any contact may press then
/// multipliers  [entries] l [N s^2]; taken as 0 in iteration 0
/// inverse_h2   1 / h^2 [1/s^2], h the substep
/// others as in gather_contacts (contact/rows.h)
WEFT_NARROW_KERNEL(project_contacts, WEFT_GLOBAL float4* positions, WEFT_GLOBAL float4* snapshots,
                   WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* counts,
                   WEFT_GLOBAL const int* corner0, WEFT_GLOBAL const int* corner1,
                   WEFT_GLOBAL const int* corner2, WEFT_GLOBAL const int* corner3,
                   WEFT_GLOBAL const float4* normals, WEFT_GLOBAL const float4* weights,
                   WEFT_GLOBAL const float4* measures, WEFT_GLOBAL float* multipliers,
                   int vertex_count, float inverse_h2, int iteration) {
    const whole count = load_whole(counts, i);
    const int longest = largest_whole(count);
    if (longest > 0) {
        WEFT_GLOBAL const float4* snapshot = snapshots + vertex_count * (iteration % 2);
        const item next = column(i, vertex_count, (iteration + 1) % 2);
        const whole start = load_whole(rows, i);
        const real zero = splat(0.0f);
        const real4 x = load4(positions, i);
        real3 push = make3(zero, zero, zero);
        real crowd = zero;
        for (int k = 0; k < longest; ++k) {
            const mask on = splat_whole(k) < count;
            const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
            const contact_entry c = load_contact(snapshot, corner0, corner1, corner2, corner3,
                                                 normals, weights, measures, entry);
            const real multiplier = iteration == 0 ? zero : gather(multipliers, entry);
            const mask presses = (c.gap < c.range ? splat(1.0f) : multiplier) > zero;
            crowd = both(on, presses) ? crowd + c.own : crowd;
            // What neither presses nor has pressed does not change.
            if (!any_item(both(on, presses))) {
                if (iteration == 0) scatter_where(on, multipliers, entry, zero);
                continue;
            }
            const real lightness =
                lightness_of(snapshot, corner0, corner1, corner2, corner3, weights, entry);
            const real change = change_of_multiplier(c, multiplier, lightness, inverse_h2);
            scatter_where(on, multipliers, entry, multiplier + change);
            push = add_scaled(push, c.normal, on ? c.own * change : zero);
        }
        store4(positions, i, with_w(add_scaled(xyz(x), push, x.w), x.w));
        const real light = x.w * larger(crowd, splat(1.0f));
        store4_where(splat_whole(0) < count, snapshots, next,
                     with_w(xyz(load4(snapshots, next)), light));
    }
}

/// What a contact's surfaces rub each other by, as an impulse times the substep [N s^2], after one
/// more step towards -mu l f(|u|/e) u/|u| (contact/friction.h), which is as far as Coulomb's law
/// lets it go: mu l.
/// rub  what it was
/// cap  mu l
WEFT_INLINE real3 rubbed(contact_entry c, real3 rub, real cap, real lightness, float creep) {
    const real one = splat(1.0f);
    const real stick = cap * friction_grip(length3(c.slip), splat(creep));
    const real rest = one / (one + stick * lightness);
    const real3 next = add_scaled(scale(rub, one - rest), c.slip, -stick * rest);
    return scale(next, cap / larger(length3(next), larger(cap, splat(1e-30f))));
}

/// Of a vector's components, without their signs. (Squares of small ones would be 0.)
WEFT_INLINE real largest_part(real3 v) {
    return larger(larger(size_of(v.x), size_of(v.y)), size_of(v.z));
}

/// Holds back what slides, across the normals: behind project_contacts, from the same snapshot, by
/// how hard it has made contacts press. What a vertex' contacts have of its mass they have in each
/// direction. Over all vertices.
/// multipliers  [entries] l [N s^2], those of this iteration
/// rubs         [entries] xyz: the impulse times the substep along the surfaces [N s^2]; taken as 0
///              in iteration 0
/// friction     Coulomb coefficient mu
/// creep        e [m] > 0
/// others as in project_contacts
WEFT_NARROW_KERNEL(rub_contacts, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const float4* snapshots,
                   WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* counts,
                   WEFT_GLOBAL const int* corner0, WEFT_GLOBAL const int* corner1,
                   WEFT_GLOBAL const int* corner2, WEFT_GLOBAL const int* corner3,
                   WEFT_GLOBAL const float4* normals, WEFT_GLOBAL const float4* weights,
                   WEFT_GLOBAL const float4* measures, WEFT_GLOBAL const float4* slips,
                   WEFT_GLOBAL const float* multipliers, WEFT_GLOBAL float4* rubs, int vertex_count,
                   int iteration, float friction, float creep) {
    const whole count = load_whole(counts, i);
    const int longest = largest_whole(count);
    if (longest > 0) {
        WEFT_GLOBAL const float4* snapshot = snapshots + vertex_count * (iteration % 2);
        const whole start = load_whole(rows, i);
        const real zero = splat(0.0f);
        const real3 none = make3(zero, zero, zero);
        const real4 x = load4(positions, i);
        real3 push = none;
        for (int k = 0; k < longest; ++k) {
            const mask on = splat_whole(k) < count;
            const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
            const real3 rub = iteration == 0 ? none : xyz(gather4(rubs, entry));
            const real cap = splat(friction) * gather(multipliers, entry);
            // Nor does what neither is pressed nor has rubbed.
            if (!any_item(both(on, larger(cap, largest_part(rub)) > zero))) {
                if (iteration == 0) scatter4_where(on, rubs, entry, with_w(none, zero));
                continue;
            }
            const contact_entry c =
                with_earlier_slip(load_contact(snapshot, corner0, corner1, corner2, corner3,
                                               normals, weights, measures, entry),
                                  slips, entry);
            const real lightness =
                lightness_of(snapshot, corner0, corner1, corner2, corner3, weights, entry);
            const real3 next = rubbed(c, rub, cap, lightness, creep);
            scatter4_where(on, rubs, entry, with_w(next, zero));
            push = add_scaled(push, subtract(next, rub), on ? c.own : zero);
        }
        store4(positions, i, with_w(add_scaled(xyz(x), push, x.w), x.w));
    }
}

WEFT_KERNELS_END

#endif
