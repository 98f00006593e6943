#ifndef WEFT_KERNELS_CONTACT_GROUPS_H
#define WEFT_KERNELS_CONTACT_GROUPS_H

// The step that free bodies which touch each other take as one rigid whole, behind that of each of
// them: see bodies.h. It takes what they lack in common of linear and angular momentum, against
// what pushes them from outside.
//
// In other rounds their halves take such steps instead, on both sides of their middle, or the
// halves of these, in scenes of many bodies down to parts of a few: how a tower bends is neither a
// matter of single bodies, whose steps are about the square of its height too short for that, nor
// of the whole (docs/measurements.md, "Towers"). Nor is how a pile is stopped that falls
// (docs/measurements.md, "Stacks that land").

#include "kernels/contact/bodies.h"

WEFT_KERNELS_BEGIN

/// Where a body's centre of mass is by now.
WEFT_INLINE real3 gather_centre(WEFT_GLOBAL const float4* moments_of,
                                WEFT_GLOBAL const float4* motions, integer body) {
    return add(xyz(gather4(moments_of, body)), xyz(gather4(motions, body)));
}

/// The k-th body of each group, or its first one where there are fewer.
WEFT_INLINE integer body_in_group(WEFT_GLOBAL const int* members, whole first, mask on, int k) {
    return address(gather_whole(members, address(on ? first + splat_whole(k) : first)));
}

/// How far groups have to go then. A group's first body does it for all.
/// rests         [7 * bodies] as solve_bodies leaves them
/// moments_of    [9 * (bodies + 1)] as weigh_bodies leaves them
/// motions       [2 * (bodies + 1)] with solve_bodies' step
/// firsts        [substeps * level_count * bodies] where a group's bodies begin in `members`
/// counts        [substeps * level_count * bodies] how many there are; 0 for all but the first one
///               of a group
/// members       [substeps * level_count * bodies] groups side by side
/// are_led       [bodies + 1] 1: a solid; see move_bodies
/// group_motions [3 * bodies] written, column-major: of the groups that begin there; about xyz [m],
///               and w: 1 where a solid is among them, else 0
/// level         of groups
WEFT_NARROW_KERNEL(solve_groups, WEFT_GLOBAL const float4* rests,
                   WEFT_GLOBAL const float4* moments_of, WEFT_GLOBAL const float4* motions,
                   WEFT_GLOBAL const int* firsts, WEFT_GLOBAL const int* counts,
                   WEFT_GLOBAL const int* members, WEFT_GLOBAL const float* are_led,
                   WEFT_GLOBAL float4* group_motions, int level, int level_count, int body_count,
                   int substep) {
    const real zero = splat(0.0f);
    const int table = level_count * substep + level;
    const item now = column(i, body_count, table);
    const whole first = load_whole(firsts, now);
    const whole count = load_whole(counts, now);
    const int longest = largest_whole(count);
    WEFT_GLOBAL const int* own_members = members + table * body_count;
    real3 centre = no_motion().shift;
    real mass = zero;
    real has_solid = zero;
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer body = body_in_group(own_members, first, on, k);
        const real own = on ? gather4(rests + 6 * body_count, body).w : zero;
        centre = add_scaled(centre, gather_centre(moments_of, motions, body), own);
        mass = mass + own;
        has_solid = on ? larger(has_solid, gather(are_led, body)) : has_solid;
    }
    centre = scale(centre, splat(1.0f) / divisor(mass));

    body_motion left = no_motion();
    sym6 form = no_sym6();
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer body = body_in_group(own_members, first, on, k);
        const real4 shift = gather4(rests + 5 * body_count, body);
        const real3 turn = xyz(gather4(rests + 6 * body_count, body));
        const sym6 own_form = gather_sym6(rests, body_count, body, shift.w);
        const real3 lever = subtract(gather_centre(moments_of, motions, body), centre);
        const body_motion own_left = make_motion(xyz(shift), add(turn, cross3(lever, xyz(shift))));
        const real touches = gather4(rests + 6 * body_count, body).w > zero ? splat(1.0f) : zero;
        const real own = on ? touches : zero;
        left = add_scaled_motion(left, own_left, own);
        form = add_scaled_sym6(form, form_from(own_form, lever), own);
    }
    store_motion(group_motions, body_count, i, solve_sym6(form, left));
    store4(group_motions, column(i, body_count, 2), with_w(centre, has_solid));
}

/// Adds what its group does to the motion of each body that touches another one, which then is as
/// far as the round leads it.
/// motions  [2 * (bodies + 1)]
/// bearings [4 * (bodies + 1)] from solve_bodies, to those with how far bodies have gone
/// masses   [bodies] [kg]
/// leaders  [substeps * level_count * bodies] the first one of each body's group
/// others as in solve_groups
WEFT_KERNEL(add_groups, WEFT_GLOBAL float4* motions, WEFT_GLOBAL float4* bearings,
            WEFT_GLOBAL const float* masses, WEFT_GLOBAL const float4* rests,
            WEFT_GLOBAL const float4* moments_of, WEFT_GLOBAL const float4* group_motions,
            WEFT_GLOBAL const int* leaders, int is_rubbed, int level, int level_count,
            int body_count, int substep) {
    const real zero = splat(0.0f);
    const int table = level_count * substep + level;
    const integer leader = load_index(leaders, column(i, body_count, table));
    const integer own_number = address(item_numbers(i));
    const real touches = load4(rests, column(i, body_count, 6)).w > zero ? splat(1.0f) : zero;
    body_motion own = gather_motion(motions, body_count + 1, own_number);
    const body_motion group = gather_motion(group_motions, body_count, leader);
    const real3 centre = xyz(gather4(group_motions + 2 * body_count, leader));
    const real3 lever = subtract(gather_centre(moments_of, motions, own_number), centre);
    own.shift = add_scaled(own.shift, way_of_motion(group, lever), touches);
    own.turn = bounded_turn(add_scaled(own.turn, group.turn, touches));
    store_motion(motions, body_count + 1, i, own);
    if (is_rubbed) {
        bearing b = gather_bearing(bearings, body_count + 1, own_number);
        b.borne = add_scaled(b.borne, own.shift, load(masses, i));
        store_bearing(bearings, body_count + 1, i, b);
    }
}

WEFT_KERNELS_END

#endif
