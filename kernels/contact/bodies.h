#ifndef WEFT_KERNELS_CONTACT_BODIES_H
#define WEFT_KERNELS_CONTACT_BODIES_H

// The momentum of free bodies in scenes with contact (bodies/free_bodies.h: in those without). A
// motion of a whole body of mass M, a shift t and a turn w, is unseen by its elements and, but for
// how far these have slid, by its contacts with itself; with c and W of contact/rows.h and G the
// sum of the gradients that contacts with others leave at the body, it changes E by no more than
//
//   M/(2 h^2) (m - lag)^T J (m - lag) + G . m + 1/2 sum c W (n . way of m at the contact)^2
//
// up to second order in w, whatever the other bodies do meanwhile. m = (t, w), J has 1 for shifts
// and the inertia of turns, and J lag is what is missing of the momentum: the mean of x~ - x, and
// of r x (x~ - x), see bodies/moments.h. The minimum of that is the step that the body takes: all
// of the lag along surfaces without friction, and hardly anything of it into them. A body that
// touches no other takes the step of one in a scene without contact, to the bit.
//
// Where bodies of one group touch each other, what they lack in common is left, as each is held up
// by the others. So the group takes one more step as a whole (groups.h), unseen by contacts within
// it; where they are all that it has, its momentum is exact.
//
// There are several rounds of that, each as if bodies were already where those before it lead them.
// What too few iterations leave in single contacts may be hundreds of times what a light body needs
// to be carried. The bound above takes it for springs that pull as well as push: where one corner
// presses too hard, the others seem to hold it down, and as their normals differ a little, what is
// left of these forces leads aside. Later rounds see which contacts have opened, and undo that. And
// friction goes by how hard contacts press: in one round, what should slide would stick. How hard
// that is, is in bearings.h.
//
// Where solids are among them, bodies are led like that before the first iteration as well
// (lead_bodies). Iterations V and these steps R leave T (x~ - x*) of the way to the minimum x* of a
// substep. Implicit Euler damps what is left where T has real eigenvalues from 0 to 1. T = R V has
// complex ones: two blocks on each other never came to rest. T = R V R has not, as each of the two
// is symmetric in the norm of E, and R done twice is R (sweeps that go one way are symmetric only
// about). Solids remember only as wholes what has held them up (deviation_of_body), as that is what
// the first R can make good.
//
// All that is in units of M / h^2, in 12 parts, or 16 with friction: float4
//   0..4   the form of motions that contacts with others have, see store_sym6
//   5      the lag less h^2/M G [m]; what is missing of the first form
//   6      the same of turns [m^2]: here h^2/M times the torque alone; and of the second form
//   7..11  as the first five, of those with what is not of the body's group
//   12..15 what bears it
// of which strains (strains.h) have the first seven.
#define WEFT_STRAIN_PARTS 7
#define WEFT_BODY_PARTS 12
#define WEFT_RUBBED_BODY_PARTS 16

#include "kernels/bodies/free_bodies.h"
#include "kernels/contact/bearings.h"
#include "kernels/contact/pushes.h"

WEFT_KERNELS_BEGIN

/// What is summed up of a body.
typedef struct {
    body_motion lag;
    sym6 block, outside;
    bearing borne;
} body_sum;

WEFT_INLINE body_sum no_body_sum(void) {
    body_sum sum = {no_motion(), no_sym6(), no_sym6(), no_bearing()};
    return sum;
}

WEFT_INLINE body_sum add_share(body_sum a, body_sum b, real share) {
    a.lag = add_scaled_motion(a.lag, b.lag, share);
    a.block = add_scaled_sym6(a.block, b.block, share);
    a.outside = add_scaled_sym6(a.outside, b.outside, share);
    a.borne = add_scaled_bearing(a.borne, b.borne, share);
    return a;
}

/// What a contact does to a body.
/// lever     of the contact's point
/// yielding  h^2 / M of the body [m/N]
/// outside   1 where the other side is not of the body's group, or 0
WEFT_INLINE body_sum add_push_at(body_sum sum, derivatives push, real3 lever, real yielding,
                                 real outside) {
    const real3 force = scale(push.gradient, -yielding);
    const sym6 form = form_at_lever(scale_sym(push.hessian, yielding), lever);
    sum.lag.shift = add(sum.lag.shift, force);
    sum.lag.turn = add(sum.lag.turn, cross3(lever, force));
    sum.block = add_scaled_sym6(sum.block, form, splat(1.0f));
    sum.outside = add_scaled_sym6(sum.outside, form, outside);
    return sum;
}

/// What a contact that rubs says of how its body is borne.
/// mean     how hard it presses, over the rounds up to this one
/// pressed  how hard this round has told that it does
/// part     that the body had in telling it
/// pull     of friction, as in add_rubbing
/// is_known  which of the two bodies tells; 0 in the first round, where both do
WEFT_INLINE bearing bearing_at(contact_entry c, real mean, real pressed, real part, real pull,
                               real is_known, real yielding) {
    const real own = c.own * yielding;
    const real known = pressed * (splat(1.0f) - part);
    bearing b = {add_scaled(scale(c.slip, pull * own), c.normal, -(known * own)),
                 scale(c.normal, mean * part * own), mean * own,
                 outer_sym(c.normal, mean * part * own * is_known)};
    return b;
}

/// What it does to the body's strain.
WEFT_INLINE body_sum add_strain_at(body_sum sum, derivatives push, real3 lever, real yielding) {
    const real3 force = scale(push.gradient, -yielding);
    const mat3 stretch = stretch_mat(lever);
    const mat3 shear = shear_mat(lever);
    const sym6 form = form_of_arms(scale_sym(push.hessian, yielding), stretch, shear);
    sum.lag.shift = add(sum.lag.shift, multiply_transposed_mat(stretch, force));
    sum.lag.turn = add(sum.lag.turn, multiply_transposed_mat(shear, force));
    sum.block = add_scaled_sym6(sum.block, form, splat(1.0f));
    return sum;
}

/// What is missing of the momentum of columns, and what contacts do.
/// standing       [columns] as collect_pushes leaves it, as are rows to other_points
/// column_bodies  [columns] of which body each is
/// masses         [bodies] [kg]
/// moments_of     [9 * (bodies + 1)] as weigh_bodies leaves them; of the last one zero
/// motions        [2 * (bodies + 1)] column-major: how far each has gone in the rounds before; the
///                last one is zero
/// strains        [2 * (bodies + 1)] likewise: how they have given way (strains.h)
/// bearings       [4 * (bodies + 1)] as add_groups leaves them (groups.h)
/// presses        [entries] how hard contacts press: from the mean over the rounds before, to that
///                with this one, but for strains [N]
/// partials       [12 or 16 * columns] written, column-major, see above; behind the first round
///                where it may have changed
/// friction, creep  as in add_push
/// h2             the square of the substep [s^2]
/// is_rubbed      1 with friction, of contacts or of obstacles
/// has_moved      0 in the first round, where `motions` has those of another substep, which may
///                have ended badly: nothing reads them, nor `strains` and `bearings`
/// is_strained    1 where strains have changed since the round before
/// is_strain      1 where the sums are to be of what contacts do to strains, and of that alone
/// level          of the groups whose step follows
WEFT_NARROW_KERNEL(add_pushed_lags, WEFT_GLOBAL const float4* standing,
                   WEFT_GLOBAL const int* column_bodies, WEFT_GLOBAL const float* masses,
                   WEFT_GLOBAL const float4* moments_of, WEFT_GLOBAL const float4* motions,
                   WEFT_GLOBAL const float4* strains, WEFT_GLOBAL const float4* bearings,
                   WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* counts,
                   WEFT_GLOBAL const int* codes, WEFT_GLOBAL const float4* sides,
                   WEFT_GLOBAL const float4* slips, WEFT_GLOBAL const float4* forces,
                   WEFT_GLOBAL const float4* points, WEFT_GLOBAL const float4* other_points,
                   WEFT_GLOBAL float* presses, WEFT_GLOBAL float4* partials, float friction,
                   float creep, float h2, int is_rubbed, int has_moved, int is_strained,
                   int is_strain, int level, int column_count, int body_count) {
    const real zero = splat(0.0f);
    const real3 no_way = no_motion().shift;
    const real one = splat(1.0f);
    const integer own_body = load_index(column_bodies, i);
    const real yielding = splat(h2) / gather(masses, own_body);
    const real3 centre = xyz(gather4(moments_of, own_body));
    body_motion own = no_motion();
    body_motion own_strain = no_motion();
    bearing own_bearing = no_bearing();
    if (has_moved) {
        if (is_rubbed) own_bearing = gather_bearing(bearings, body_count + 1, own_body);
        own = gather_motion(motions, body_count + 1, own_body);
        own_strain = gather_motion(strains, body_count + 1, own_body);
    }
    body_sum sum = no_body_sum();
    if (!is_strain) {
        const real4 left = load4(standing, i);
        sum.lag.shift = xyz(left);
        if (has_moved) sum.lag.shift = add_scaled(sum.lag.shift, own.shift, -left.w);
    }

    const whole count = load_whole(counts, i);
    const int longest = largest_whole(count);
    if (has_moved && longest == 0) {  // All else is zero since the first round.
        store4(partials, column(i, column_count, 5), with_w(sum.lag.shift, zero));
        return;
    }
    const whole start = load_whole(rows, i);
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
        contact_entry c = load_push(sides, slips, forces, entry);
        const whole code = gather_whole(codes, entry);
        const whole opposite = body_of_code(code);
        const real4 point = gather4(points, entry);
        const real4 other_point = gather4(other_points, entry);
        const mask rests = both(on, point.w >= zero);
        const mask meets = both(on, point.w < zero);
        real press = zero;
        if (is_rubbed) press = on ? gather(presses, entry) : zero;
        telling told = told_by_one();
        real3 lever = subtract(xyz(point), centre);
        if (has_moved) {
            const integer other = address(opposite);
            const real3 other_lever = subtract(xyz(other_point), xyz(gather4(moments_of, other)));
            const real3 other_way =
                add(way_of_motion(gather_motion(motions, body_count + 1, other), other_lever),
                    way_of_strain(gather_motion(strains, body_count + 1, other), other_lever));
            const real3 turned = way_of_turn(own.turn, lever);
            const real3 own_way = add(add(own.shift, turned), way_of_strain(own_strain, lever));
            const real3 apart = subtract(own_way, other_way);
            c = moved_push(c, apart);
            // Of two free bodies the middle between again, as forces on both may turn nothing.
            const real inward = opposite < splat_whole(body_count) ? splat(-0.5f) : zero;
            lever = add_scaled(add(lever, turned), along_surface(apart, c.normal), inward);
            if (is_rubbed) {
                const bearing other_bearing = gather_bearing(bearings, body_count + 1, other);
                told =
                    tell(own_bearing, other_bearing, opposite < splat_whole(body_count), c.normal);
            }
        }
        const mask is_on = both(on, (is_pushed(c) ? one : press) > zero);
        if (!any_item(is_on) && !any_item(rests)) continue;
        derivatives push = add_push(zero_derivatives(), c, meets, no_way, 0.0f, creep);
        push = add_resting(push, c, rests, other_point.w);
        if (is_rubbed) {
            const real pressed = press * told.correction;
            const real grip = friction_grip(length3(c.slip), splat(creep));
            const real pull = (rests ? point.w : splat(friction)) * pressed * grip;
            push = add_rubbing(push, c, pull, no_way);
            if (!is_strain) {
                const real now = rests ? press_of_resting(c, other_point.w) : press_of_gap(c);
                // Before they are led, how far solids are in obstacles does not say; nor does it
                // where a strain has just pressed some corners and lifted others.
                real mean = splat(0.5f) * (press + now);
                if (!has_moved || is_strained) mean = rests ? press : mean;
                bearing said =
                    bearing_at(c, mean, pressed, told.part, pull, has_moved ? one : zero, yielding);
                const real known = rests ? other_point.w * yielding : zero;
                said.borne = add_scaled(said.borne, c.normal, known);
                scatter_where(on, presses, entry, mean);
                sum.borne = add_scaled_bearing(sum.borne, said, on ? one : zero);
            }
        }
        const whole inside = code - code_of_body(opposite);
        const real outside = inside > splat_whole(level) ? zero : one;
        if (is_strain)
            sum = add_strain_at(sum, push, lever, yielding);
        else
            sum = add_push_at(sum, push, lever, yielding, outside);
    }
    store_sym6(partials, column_count, i, sum.block);
    store4(partials, column(i, column_count, 5), with_w(sum.lag.shift, sum.block.mixed.z.z));
    store4(partials, column(i, column_count, 6), with_w(sum.lag.turn, sum.outside.mixed.z.z));
    if (is_strain) return;
    store_sym6(partials + 7 * column_count, column_count, i, sum.outside);
    if (is_rubbed)
        store_bearing(partials + WEFT_BODY_PARTS * column_count, column_count, i, sum.borne);
}

/// What a run has of strains; of motions that is all but what is outside.
WEFT_INLINE body_sum gather_strain_sum(WEFT_GLOBAL const float4* lags, int lag_count, integer run) {
    const real4 shift = gather4(lags + 5 * lag_count, run);
    body_sum sum = no_body_sum();
    sum.lag = make_motion(xyz(shift), xyz(gather4(lags + 6 * lag_count, run)));
    sum.block = gather_sym6(lags, lag_count, run, shift.w);
    return sum;
}

WEFT_INLINE body_sum gather_body_sum(WEFT_GLOBAL const float4* lags, int lag_count, integer run,
                                     int is_rubbed) {
    body_sum sum = gather_strain_sum(lags, lag_count, run);
    const real zz = gather4(lags + 6 * lag_count, run).w;
    sum.outside = gather_sym6(lags + 7 * lag_count, lag_count, run, zz);
    if (is_rubbed) sum.borne = gather_bearing(lags + WEFT_BODY_PARTS * lag_count, lag_count, run);
    return sum;
}

/// What a body leaves to its group.
/// rests  [7 * rows] column-major: the form of the body and of what is not of its group, see
///        store_sym6; then what is left of shifts, the last of the form; and of turns, the mass,
///        or 0 if it touches no other body [kg]
WEFT_INLINE void store_rest(WEFT_GLOBAL float4* rests, int rows, item i, sym6 form,
                            body_motion left, real mass) {
    store_sym6(rests, rows, i, add_scaled_sym6(no_sym6(), form, mass));
    store4(rests, column(i, rows, 5), with_w(scale(left.shift, mass), form.mixed.z.z * mass));
    store4(rests, column(i, rows, 6), with_w(scale(left.turn, mass), mass));
}

/// How far each body has to go, as if it were the only one.
/// lags       [12 or 16 * lag_count] of the runs and more rows, column-major, see above
/// first_run  [bodies]
/// counts     [bodies] of its runs
/// masses     [bodies] [kg]
/// moments_of [9 * (bodies + 1)] as weigh_bodies leaves them
/// motions    [2 * (bodies + 1)] from those of the rounds before to those with this one
/// strains    [2 * (bodies + 1)] none of them in the first round
/// rests      [7 * bodies] written, see store_rest
/// bearings   [4 * (bodies + 1)] written with friction; how far bodies have gone is in that, unless
///            has_groups: then groups.h adds it
/// has_moved  as in add_pushed_lags
/// is_rubbed  1 with friction
/// most_runs  that a body has; lag_count is that more than there are runs
/// held       as in missing_motion
WEFT_KERNEL(solve_bodies, WEFT_GLOBAL const float4* lags, WEFT_GLOBAL const int* first_run,
            WEFT_GLOBAL const float* counts, WEFT_GLOBAL const float* masses,
            WEFT_GLOBAL const float4* moments_of, WEFT_GLOBAL float4* motions,
            WEFT_GLOBAL float4* strains, WEFT_GLOBAL float4* rests, WEFT_GLOBAL float4* bearings,
            int has_moved, int is_rubbed, int has_groups, int most_runs, int lag_count,
            int body_count, float held) {
    const real zero = splat(0.0f);
    body_sum sum = no_body_sum();
    const integer first = load_index(first_run, i);
    const real count = load(counts, i);
    for (int k = 0; k < most_runs; ++k) {
        const real own = splat((float)k) < count ? splat(1.0f) : zero;
        sum = add_share(sum, gather_body_sum(lags + k, lag_count, first, is_rubbed), own);
    }
    const integer own_number = address(item_numbers(i));
    const moments body = gather_moments(moments_of, body_count + 1, own_number);
    body_motion gone = no_motion();
    if (has_moved) {
        gone = gather_motion(motions, body_count + 1, own_number);
        const body_motion strain = gather_motion(strains, body_count + 1, own_number);
        sum.lag.turn = add(sum.lag.turn, axis_of(strained_ways(body.spread, strain)));
    } else {
        store_motion(strains, body_count + 1, i, no_motion());
    }
    sum.lag.turn = add(sum.lag.turn, lag_of_turn(body, gone.turn));
    const borne_lag borne_by = without_throw(sum.lag.shift, body, gone.shift);
    sum.lag.shift = borne_by.lag;
    sum.lag.turn = add_scaled(sum.lag.turn, body.torque, -borne_by.share);

    sym6 own_form = own_form_of(body);
    const real hold = body.pushed * splat(held);
    const real3 turned = multiply_sym(own_form.turn, gone.turn);
    sum.lag.shift = add_scaled(sum.lag.shift, gone.shift, -hold);
    sum.lag.turn = add_scaled(sum.lag.turn, turned, -hold);
    own_form.shift = add_diagonal(own_form.shift, hold);
    own_form.turn = scale_sym(own_form.turn, splat(1.0f) + hold);
    body_motion alone = no_motion();
    if (has_moved) {
        alone.shift = scale(sum.lag.shift, part_led(hold));
    } else {
        alone = missing_motion(body, borne_by, held);
    }

    const real mass = trace_sym(sum.block.shift) > zero ? load(masses, i) : zero;
    const real touching = mass > zero ? splat(1.0f) : zero;
    body_motion step = solve_sym6(add_scaled_sym6(sum.block, own_form, splat(1.0f)), sum.lag);
    step = add_scaled_motion(add_scaled_motion(no_motion(), step, touching), alone,
                             splat(1.0f) - touching);
    const sym6 form = add_scaled_sym6(sum.outside, own_form, splat(1.0f));
    body_motion left = add_scaled_motion(sum.lag, multiply_sym6(form, step), splat(-1.0f));
    // About where the step leads: forces within a group, which are far larger than what it lacks,
    // have to turn nothing as its bodies' levers add them up.
    left.turn = subtract(left.turn, cross3(step.shift, left.shift));
    gone = add_scaled_motion(gone, step, splat(1.0f));
    gone.turn = bounded_turn(gone.turn);
    store_motion(motions, body_count + 1, i, gone);
    if (is_rubbed) {
        sum.borne.borne = subtract(sum.borne.borne, body.lag);
        if (!has_groups) sum.borne.borne = add(sum.borne.borne, gone.shift);
        const bearing borne = add_scaled_bearing(no_bearing(), sum.borne, load(masses, i));
        store_bearing(bearings, body_count + 1, i, borne);
    }
    store_rest(rests, body_count, i, form, left, mass);
}

/// How far a vertex goes with its body.
/// others as in move_bodies
WEFT_INLINE real3 way_with_body(WEFT_GLOBAL const float4* motions,
                                WEFT_GLOBAL const float4* strains,
                                WEFT_GLOBAL const float4* moments_of, real3 x, integer body,
                                int body_count) {
    const real3 lever = subtract(x, xyz(gather4(moments_of, body)));
    return add(way_of_motion(gather_motion(motions, body_count + 1, body), lever),
               way_of_strain(gather_motion(strains, body_count + 1, body), lever));
}

/// Moves the vertices of free bodies before the first iteration of a substep.
/// are_led [bodies + 1] 1 for those that are to be moved, 0 for others
/// less    by how much less bodies go than they would [m]
/// others  as in move_bodies
WEFT_KERNEL(lead_bodies, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const float4* motions,
            WEFT_GLOBAL const float4* strains, WEFT_GLOBAL const float4* moments_of,
            WEFT_GLOBAL const float* are_led, WEFT_GLOBAL const int* bodies, float less,
            int body_count) {
    const real4 x = load4(positions, i);
    const integer body = load_index(bodies, i);
    const real3 way = way_with_body(motions, strains, moments_of, xyz(x), body, body_count);
    const real far = length3(gather_motion(motions, body_count + 1, body).shift);
    const real left = larger(far - splat(less), splat(0.0f)) / divisor(far);
    const real part = (less > 0.0f ? left : splat(1.0f)) * gather(are_led, body);
    store4(positions, i, with_w(add_scaled(xyz(x), way, part), x.w));
}

/// x - x~ of a body, in the mean.
WEFT_INLINE real3 deviation_of_body(WEFT_GLOBAL const float4* motions,
                                    WEFT_GLOBAL const float4* moments_of, integer body,
                                    int body_count) {
    const int rows = body_count + 1;
    const real3 lag =
        make3(gather4(moments_of + 3 * rows, body).w, gather4(moments_of + 4 * rows, body).w,
              gather4(moments_of + 5 * rows, body).w);
    return subtract(gather_motion(motions, rows, body).shift, lag);
}

/// Moves the vertices of free bodies; see move_runs. Rounds know how obstacles rub solids, but not
/// how they rub cloth. A light sheet between a solid and the ground went as far as the solid's
/// friction led it, was brought back by the ground's in the iterations that followed, and had been
/// strained by both: the solid was thrown up by tens of joules (docs/measurements.md, "Solids on
/// stiff sheets"). So in groups with solids it is held on obstacles as where it lies alone.
/// positions, deviations, velocities, inverse_h  as there
/// motions, strains  [2 * (bodies + 1)] the last one is zero
/// moments_of  [9 * (bodies + 1)] likewise
/// group_motions, leaders  as solve_groups leaves the first, of whole groups, and as in add_groups:
///             not read unless held > 0
/// held        how hard obstacles hold cloth, as in missing_motion; 0: not at all
/// are_led     [bodies + 1] 1: the next substep starts from where the body is led as a whole, and
///             so from what has held it up as a whole, alike at all of its vertices; else 0
/// bodies      [vertices] which each belongs to; the last one: to none
WEFT_KERNEL(move_bodies, WEFT_GLOBAL float4* positions, WEFT_GLOBAL float4* deviations,
            WEFT_GLOBAL float4* velocities, WEFT_GLOBAL const float4* motions,
            WEFT_GLOBAL const float4* strains, WEFT_GLOBAL const float4* moments_of,
            WEFT_GLOBAL const float* are_led, WEFT_GLOBAL const int* bodies,
            WEFT_GLOBAL const float4* group_motions, WEFT_GLOBAL const int* leaders,
            float inverse_h, float held, int level_count, int body_count, int substep) {
    const integer body = load_index(bodies, i);
    const real3 x = xyz(load4(positions, i));
    const real is_led = gather(are_led, body);
    real3 way = way_with_body(motions, strains, moments_of, x, body, body_count);
    if (held > 0.0f) {
        const whole number = load_whole(bodies, i);
        const whole own = number < splat_whole(body_count) ? number : splat_whole(0);
        WEFT_GLOBAL const int* now = leaders + level_count * substep * body_count;
        const integer leader = address(gather_whole(now, address(own)));
        const real beside_solids = gather4(group_motions + 2 * body_count, leader).w;
        const real pushed = gather4(moments_of + 6 * (body_count + 1), body).w;
        const real hold = pushed * splat(held) * beside_solids * (splat(1.0f) - is_led);
        way = scale(way, part_led(hold));
    }
    shift_vertex(positions, deviations, velocities, i, way, inverse_h);
    if (!any_item(is_led > splat(0.0f))) return;
    const real4 own = load4(deviations, i);
    const real3 whole_body = deviation_of_body(motions, moments_of, body, body_count);
    const real3 rest = scale(xyz(own), splat(1.0f) - is_led);
    store4(deviations, i, with_w(add_scaled(rest, whole_body, is_led), own.w));
}

WEFT_KERNELS_END

#endif
