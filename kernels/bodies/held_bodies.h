#ifndef WEFT_KERNELS_BODIES_HELD_BODIES_H
#define WEFT_KERNELS_BODIES_HELD_BODIES_H

// Bodies of which some vertices are held, moved as wholes against these. Elements are some hundred
// times as hard as inertia, and each sweep leads what a body does as a whole on by so little: a
// sheet that should swing down from two corners came down as if in honey, whatever its iterations,
// and what it weighs hung on the first few rows of elements. So behind the iterations of a substep
// E is made less by one motion of all that is not held, about a held vertex: a shift s and a turn
// w. Elements between free vertices do not see it, and to those that are held it is as if these had
// moved the other way. With r from that vertex, M the mass of all that is free, and g and H the
// gradient and the Hessian block of each held vertex p (an element's two held ones are coupled,
// too: so many times the block is no less),
//
//   E(s, w) = M / (2 h^2) mean |x + s + R r - r - x~|^2
//           + sum_p 1/2 d_p . H_p d_p - g_p . d_p,    d_p = s + w x r_p
//
// which is a Galerkin correction with one aggregate, of six unknowns (cf. newton/coarse.h). Where
// all that is held lies on a line or in a point, turns about there cost no element anything; stiff
// elements make these small numbers beside large ones, and then, and where elements would be led
// farther than they are linear, there is a turn alone: at the minimum of E the body lacks no
// angular momentum about the line, and what held it had no torque.
//
// How obstacles would answer is not known here: what they push moves the less, as if it were held
// by some fifty times its inertia. Forces of other bodies are not in x~, as pushes are: what
// touches one is not moved.

#include "kernels/bodies/free_bodies.h"
#include "kernels/bodies/moments.h"
#include "kernels/descent/rows.h"
#include "kernels/row_stride.h"

/// Of the pulls of held vertices: force, torque, and the form of motions.
#define WEFT_PULL_PARTS 7

/// What would be turned by more in a substep is not moved, in radians.
#define WEFT_MOST_TURN 0.25f

WEFT_KERNELS_BEGIN

/// How many contacts with other bodies a vertex has; 0: none.
/// parameters  as below
WEFT_INLINE real contacts_with_others(WEFT_GLOBAL const float* bodies, WEFT_GLOBAL const int* rows,
                                      WEFT_GLOBAL const int* counts, WEFT_GLOBAL const int* corner0,
                                      WEFT_GLOBAL const int* corner1,
                                      WEFT_GLOBAL const int* corner2,
                                      WEFT_GLOBAL const int* corner3, item i) {
    const real own = load(bodies, i);
    const whole start = load_whole(rows, i);
    const whole count = load_whole(counts, i);
    const int longest = largest_whole(count);
    real sum = splat(0.0f);
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
        const real a = gather(bodies, address(gather_whole(corner0, entry))) - own;
        const real b = gather(bodies, address(gather_whole(corner1, entry))) - own;
        const real c = gather(bodies, address(gather_whole(corner2, entry))) - own;
        const real d = gather(bodies, address(gather_whole(corner3, entry))) - own;
        const real apart = a * a + b * b + c * c + d * d;
        sum = sum + (on ? apart : splat(0.0f));
    }
    return sum;
}

/// x~ as sums of held bodies see it: w is above 0 of what obstacles have pushed in the substep, and
/// of what touches another body.
/// targets, starts  [vertices] xyz: x~ with all pushes, and before them [m]
/// bodies   [vertices] the number of each one's body
/// rows, counts, corner0 to corner3  as in gather_contacts (contact/rows.h); they and bodies are not
///          read unless has_contacts
/// seen     [vertices] written
WEFT_KERNEL(see_held, WEFT_GLOBAL const float4* targets, WEFT_GLOBAL const float4* starts,
            WEFT_GLOBAL const float* bodies, WEFT_GLOBAL const int* rows,
            WEFT_GLOBAL const int* counts, WEFT_GLOBAL const int* corner0,
            WEFT_GLOBAL const int* corner1, WEFT_GLOBAL const int* corner2,
            WEFT_GLOBAL const int* corner3, WEFT_GLOBAL float4* seen, int has_contacts) {
    const real3 target = xyz(load4(targets, i));
    const real3 push = subtract(target, xyz(load4(starts, i)));
    real pushed = dot3(push, push);
    if (has_contacts) {
        pushed = pushed +
                 contacts_with_others(bodies, rows, counts, corner0, corner1, corner2, corner3, i);
    }
    store4(seen, i, with_w(target, pushed));
}

/// Where bodies are held, behind the iterations of a substep.
/// positions  [vertices] xyz [m]
/// ends       [2 * runs] column-major: the held vertex that each run's body is moved about, and the
///            one farthest from it; the same again where all are in a point
/// hinges     [2 * runs] column-major, written: where the first is [m], and from there to the other
WEFT_KERNEL(find_hinges, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* ends,
            WEFT_GLOBAL float4* hinges, int run_count) {
    const real zero = splat(0.0f);
    const real3 from = xyz(gather4(positions, load_index(ends, i)));
    const real3 to = xyz(gather4(positions, load_index(ends, column(i, run_count, 1))));
    store4(hinges, i, with_w(from, zero));
    store4(hinges, column(i, run_count, 1), with_w(subtract(to, from), zero));
}

/// What held vertices pull a body by, and how hard they hold it against motions.
typedef struct {
    body_motion pull;  ///< force [N], and torque [N m]
    sym6 form;         ///< [N/m], ...
} hold;

WEFT_INLINE hold no_hold(void) {
    const hold none = {no_motion(), no_sym6()};
    return none;
}

/// table  [7 * rows] column-major
WEFT_INLINE void store_hold(WEFT_GLOBAL float4* table, int rows, item i, hold h) {
    const item rest = column(i, rows, 2);
    store4(table, i, with_w(h.pull.shift, h.form.mixed.z.z));
    store4(table, column(i, rows, 1), with_w(h.pull.turn, splat(0.0f)));
    store_sym6(table, rows, rest, h.form);
}

/// The parts of row k, of which the next one is so many further.
WEFT_INLINE hold gather_hold(WEFT_GLOBAL const float4* table, int stride, integer k) {
    const real4 force = gather4(table, k);
    hold h;
    h.pull = make_motion(xyz(force), xyz(gather4(table + stride, k)));
    h.form = gather_sym6(table + 2 * stride, stride, k, force.w);
    return h;
}

/// Adds up held vertices by columns.
/// positions  [vertices] xyz [m]
/// now        [vertices] xyz: where what is held has been led to since then [m]; not read unless
///            has_ways
/// vertices   [held] the vertex of each
/// sums       [9 * held] g and H of it; see descent/rows.h
/// members, shares, rows  see runs.h, of numbers of held vertices: how many of each one's elements'
///            corners are held at most, 0 where a column has fewer
/// origins    [columns] as in add_moments
/// partials   [7 * columns] written, column-major
WEFT_KERNEL(add_pulls, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float4* now,
            WEFT_GLOBAL const int* vertices, WEFT_GLOBAL const float* sums,
            WEFT_GLOBAL const int* members, WEFT_GLOBAL const float* shares,
            WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* origins,
            WEFT_GLOBAL float4* partials, int held_count, int column_count, int has_ways) {
    const real3 origin = xyz(gather4(positions, load_index(origins, i)));
    const real3 carried =
        has_ways ? subtract(xyz(gather4(now, load_index(origins, i))), origin) : no_motion().shift;
    hold sum = no_hold();
    const int length = rows[2 * i.first + 1];
    for (int k = 0; k < length; ++k) {
        const item entry = {rows[2 * i.first] + WEFT_RUN_COLUMNS * k, i.count};
        const integer p = load_index(members, entry);
        const real share = load(shares, entry);
        const real own = share > splat(0.0f) ? splat(1.0f) : splat(0.0f);
        const integer v = address(gather_whole(vertices, p));
        const real3 r = subtract(xyz(gather4(positions, v)), origin);
        real3 g =
            make3(gather(sums, p), gather(sums + held_count, p), gather(sums + 2 * held_count, p));
        const sym3 block =
            make_sym(gather(sums + 3 * held_count, p), gather(sums + 4 * held_count, p),
                     gather(sums + 5 * held_count, p), gather(sums + 6 * held_count, p),
                     gather(sums + 7 * held_count, p), gather(sums + 8 * held_count, p));
        if (has_ways) {
            // What it is led by beside all of the body. (r is from the origin, as carried is.)
            const real3 led = subtract(subtract(xyz(gather4(now, v)), origin), add(r, carried));
            g = add(g, multiply_sym(block, led));
        }
        sum.pull = add_scaled_motion(sum.pull, make_motion(g, cross3(r, g)), own);
        sum.form = add_scaled_sym6(sum.form, form_at_lever(block, r), share);
    }
    store_hold(partials, column_count, i, sum);
}

/// sums  [7 * (runs + most_runs)] row-major; others as in sum_from_origin
WEFT_INLINE hold sum_of_holds(WEFT_GLOBAL const float4* sums, whole first, real count,
                              int most_runs) {
    const integer start = address(first * splat_whole(WEFT_PULL_PARTS));
    hold sum = no_hold();
    for (int k = 0; k < most_runs; ++k) {
        const real own = splat((float)k) < count ? splat(1.0f) : splat(0.0f);
        const hold h = gather_hold(sums + WEFT_PULL_PARTS * k, 1, start);
        sum.pull = add_scaled_motion(sum.pull, h.pull, own);
        sum.form = add_scaled_sym6(sum.form, h.form, own);
    }
    return sum;
}

/// How a body has yet to turn about a line, or a point. Each round leaves of it about its square.
/// m     from a point that is held
/// axis  a unit vector along what is held, or zero
WEFT_INLINE real3 missing_swing(moments m, real3 axis) {
    const sym3 inertia = inertia_of(m);
    const real about_axis = dot3(axis, multiply_sym(inertia, axis));
    const mask has_axis = dot3(axis, axis) > splat(0.0f);
    real3 done = no_motion().turn;
    for (int round = 0; round < 3; ++round) {
        const real3 torque = lag_of_turn(m, done);
        const real3 on_axis = scale(axis, dot3(axis, torque) / divisor(about_axis));
        const real3 any = solve_sym(inertia, torque);
        const real3 turn = {has_axis ? on_axis.x : any.x, has_axis ? on_axis.y : any.y,
                            has_axis ? on_axis.z : any.z};
        done = bounded_turn(add(done, turn));
    }
    return done;
}

/// How a body has yet to move.
/// held  in units of its inertia
WEFT_INLINE body_motion missing_beside(moments m, hold held) {
    sym6 form =
        add_scaled_sym6(form_at_lever(diagonal_sym(splat(1.0f)), m.offset), held.form, splat(1.0f));
    form.turn = add_sym(inertia_of(m), held.form.turn);
    body_motion done = no_motion();
    for (int round = 0; round < 3; ++round) {
        const real3 turned = way_of_turn(done.turn, m.offset);
        const real3 lag = subtract(subtract(m.lag, done.shift), turned);
        const real3 torque =
            subtract(lag_of_turn(m, done.turn), cross3(add(m.offset, turned), done.shift));
        const body_motion missing =
            add_scaled_motion(make_motion(lag, torque), held.pull, splat(1.0f));
        const body_motion left =
            add_scaled_motion(missing, multiply_sym6(held.form, done), splat(-1.0f));
        done = add_scaled_motion(done, solve_sym6(form, left), splat(1.0f));
        done.turn = bounded_turn(done.turn);
    }
    return done;
}

/// How a body has to move about where it is held; not at all where what is known of its elements
/// does not reach so far.
/// numbers  [3 * runs] as in solve_held
/// all      what holds it [N], [N/m]
/// line     from a point that is held to the farthest one [m]
/// held_by_others  as in solve_held
WEFT_INLINE body_motion motion_beside(moments m, hold all, real3 line,
                                      WEFT_GLOBAL const float* numbers, int run_count, item i,
                                      float held_by_others) {
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const real per_inertia = load(numbers, i);
    const hold held = {add_scaled_motion(no_motion(), all.pull, per_inertia),
                       add_scaled_sym6(no_sym6(), all.form, per_inertia)};
    const real3 axis = scale(line, one / divisor(length3(line)));
    const real3 swing = scale(missing_swing(m, axis), load(numbers, column(i, run_count, 1)));
    const body_motion beside = missing_beside(m, held);
    // Numbers have seven digits, and of inertia some should be left. Elements are taken as linear,
    // which they are for a part of their length.
    const real3 at_other_end = add(beside.shift, cross3(beside.turn, line));
    const real way = length3(beside.shift) + length3(at_other_end);
    const mask is_soft = both(trace_sym(held.form.shift) < splat(3e4f),
                              way < load(numbers, column(i, run_count, 2)));
    const body_motion motion =
        make_motion(make3(is_soft ? beside.shift.x : zero, is_soft ? beside.shift.y : zero,
                          is_soft ? beside.shift.z : zero),
                    make3(is_soft ? beside.turn.x : swing.x, is_soft ? beside.turn.y : swing.y,
                          is_soft ? beside.turn.z : swing.z));
    const real led = part_led(m.pushed * splat(held_by_others));
    // Where all of a body is in a point, what turns it is infinitely easy to turn; and what is torn
    // around by so much in a substep goes where no line points.
    const mask is_sound =
        both(dot3(motion.shift, motion.shift) < splat(1e12f),
             dot3(motion.turn, motion.turn) < splat(WEFT_MOST_TURN * WEFT_MOST_TURN));
    const real3 shift = scale(motion.shift, led), turn = scale(motion.turn, led);
    return make_motion(
        make3(is_sound ? shift.x : zero, is_sound ? shift.y : zero, is_sound ? shift.z : zero),
        make3(is_sound ? turn.x : zero, is_sound ? turn.y : zero, is_sound ? turn.z : zero));
}

/// How far the body of each run has to move.
/// sums       as in sum_from_origin
/// pulls      as in sum_of_holds
/// first_run  [runs] the first one of the same body
/// counts     [runs] of that body's runs
/// hinges     as find_hinges leaves them
/// numbers    [3 * runs] column-major: h^2 / mass of the body [s^2/kg]; 1: it can turn about what
///            holds it, 0: it cannot; how far at what holds it is too far for it to be moved [m]
/// motions    [3 * (runs + 1)] column-major, written: the shift [m], the turn, and its centre [m]
/// most_runs  that a body has
/// held_by_others  how hard what others push and touch is held, in units of its inertia
WEFT_KERNEL(solve_held, WEFT_GLOBAL const float4* sums, WEFT_GLOBAL const float4* pulls,
            WEFT_GLOBAL const int* first_run, WEFT_GLOBAL const float* counts,
            WEFT_GLOBAL const float4* hinges, WEFT_GLOBAL const float* numbers,
            WEFT_GLOBAL float4* motions, int most_runs, int run_count, float held_by_others) {
    const whole first = load_whole(first_run, i);
    const moments m = sum_from_origin(sums, first, load(counts, i), most_runs);
    const hold all = sum_of_holds(pulls, first, load(counts, i), most_runs);
    const real3 line = xyz(load4(hinges, column(i, run_count, 1)));
    store_motion(motions, run_count + 1, i,
                 motion_beside(m, all, line, numbers, run_count, i, held_by_others));
    store4(motions, column(i, run_count + 1, 2), load4(hinges, i));
}

/// Moves what is free of held bodies, and its velocities by as much per substep, as move_runs does.
/// positions   [vertices] xyz [m]
/// deviations  [vertices] xyz: x - x~ [m]
/// velocities  [vertices] xyz [m/s], w = what damping leaves per substep
/// motions     [3 * (runs + 1)] as solve_held leaves them
/// members, shares, rows  see runs.h: what has no share stays
/// runs        [columns] the run of each
/// inverse_h   1 / h [1/s], h the substep
WEFT_KERNEL(move_held, WEFT_GLOBAL float4* positions, WEFT_GLOBAL float4* deviations,
            WEFT_GLOBAL float4* velocities, WEFT_GLOBAL const float4* motions,
            WEFT_GLOBAL const int* members, WEFT_GLOBAL const float* shares,
            WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* runs, float inverse_h,
            int run_count) {
    const integer run = load_index(runs, i);
    const real3 centre = xyz(gather4(motions + 2 * (run_count + 1), run));
    const body_motion motion = gather_motion(motions, run_count + 1, run);
    const int length = rows[2 * i.first + 1];
    for (int k = 0; k < length; ++k) {
        const item entry = {rows[2 * i.first] + WEFT_RUN_COLUMNS * k, i.count};
        const integer v = load_index(members, entry);
        const mask is_free = load(shares, entry) > splat(0.0f);
        const real4 x = gather4(positions, v);
        const real3 way = way_of_motion(motion, subtract(xyz(x), centre));
        const real4 off = gather4(deviations, v);
        const real4 u = gather4(velocities, v);
        scatter4_where(is_free, positions, v, with_w(add(xyz(x), way), x.w));
        scatter4_where(is_free, deviations, v, with_w(add(xyz(off), way), off.w));
        scatter4_where(is_free, velocities, v,
                       with_w(add_scaled(xyz(u), way, u.w * splat(inverse_h)), u.w));
    }
}

WEFT_KERNELS_END

#endif
