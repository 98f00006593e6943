#ifndef WEFT_KERNELS_CONTACT_BODIES_H
#define WEFT_KERNELS_CONTACT_BODIES_H

// The momentum of free bodies in contact (descent/free_bodies.h has those that touch nothing). A
// translation t of a whole body of mass M is unseen by its elements and by its contacts with
// itself; with c and W of contact/rows.h and G the sum of the gradients that contacts with others
// leave at the body's vertices, it changes E by no more than
//
//   M/(2 h^2) (|t - lag|^2 - |lag|^2) + G . t + 1/2 sum c W (n . t)^2,     lag = mean of x~ - x,
//
// whatever the other bodies do meanwhile. The minimum of that is the step that the body takes: all
// of the lag along surfaces without friction, and hardly anything of it into them.
//
// Where bodies of one group touch each other, what they lack in common is left, as each is held up
// by the others. So the group takes one more step as a whole, unseen by contacts within it; where
// they are all that it has, its momentum is exact.
//
// There are several rounds of that, each as if bodies were already where those before it lead them.
// What too few iterations leave in single contacts may be hundreds of times what a light body needs
// to be carried. The bound above takes it for springs that pull as well as push: where one corner
// presses too hard, the others seem to hold it down, and as their normals differ a little, what is
// left of these forces leads aside. Later rounds see which contacts have opened, and undo that. And
// friction goes by how hard contacts press: in one round, what should slide would stick.
//
// All that is in units of M / h^2, in four parts: float4
//   0  the lag less h^2/M G [m]; block xx
//   1  block xy, xz, yy, yz: of h^2/M times the Hessian that contacts with others have
//   2  block zz; outside xx, xy, xz: likewise of those with what is not of the body's group
//   3  outside yy, yz, zz; 0
#define WEFT_BODY_PARTS 4

#include "kernels/contact/pushes.h"

WEFT_KERNELS_BEGIN

/// What is summed up of a body.
typedef struct {
    real3 lag;
    sym3 block, outside;
} body_sum;

WEFT_INLINE body_sum no_body_sum(void) {
    const real zero = splat(0.0f);
    body_sum sum = {make3(zero, zero, zero), diagonal_sym(zero), diagonal_sym(zero)};
    return sum;
}

WEFT_INLINE body_sum add_share(body_sum a, body_sum b, real share) {
    a.lag = add_scaled(a.lag, b.lag, share);
    a.block = add_sym(a.block, scale_sym(b.block, share));
    a.outside = add_sym(a.outside, scale_sym(b.outside, share));
    return a;
}

/// Adds what contacts with others do to a body, as one column of its vertices has collected them.
/// own_body    of the column
/// yielding    h^2 / M of the body [m/N]
/// others as in add_pushed_lags
WEFT_INLINE body_sum add_pushes_of_others(
    body_sum sum, WEFT_GLOBAL const float4* shifts, int has_moved, WEFT_GLOBAL const int* rows,
    WEFT_GLOBAL const int* counts, WEFT_GLOBAL const int* codes, WEFT_GLOBAL const float4* sides,
    WEFT_GLOBAL const float4* slips, WEFT_GLOBAL const float4* forces, item i, integer own_body,
    real yielding, float friction, float creep) {
    const real3 no_way = make3(splat(0.0f), splat(0.0f), splat(0.0f));
    const whole start = load_whole(rows, i);
    const whole count = load_whole(counts, i);
    const int longest = largest_whole(count);
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer entry = address(on ? start + splat_whole(WEFT_CONTACT_STRIDE * k) : start);
        contact_entry c = load_push(sides, slips, forces, entry);
        const whole code = gather_whole(codes, entry);
        const whole opposite = code >> splat_whole(1);
        if (has_moved) {
            const real3 way =
                subtract(xyz(gather4(shifts, own_body)), xyz(gather4(shifts, address(opposite))));
            c.gap = c.gap + dot3(way, c.normal);
            c.slip = add(c.slip, along_surface(way, c.normal));
            c.ahead = c.range;
        }
        const derivatives push = add_push(zero_derivatives(), c, on, no_way, friction, creep);
        const real outside = code > opposite + opposite ? splat(1.0f) : splat(0.0f);
        const body_sum pushed = {scale(push.gradient, splat(-1.0f)), push.hessian,
                                 scale_sym(push.hessian, outside)};
        sum = add_share(sum, pushed, yielding);
    }
    return sum;
}

/// As add_lags, with what contacts do.
/// standing       [columns] as collect_pushes leaves it, as are rows to forces
/// column_bodies  [columns] of which body each is
/// masses         [bodies] [kg]
/// shifts         [bodies + 1] how far each has gone in the rounds before [m]; the last one is zero
/// partials       [4 * columns] written, column-major, see above
/// friction, creep  as in add_push
/// h2             the square of the substep [s^2]
/// has_moved      0 in the first round, where `shifts` has those of another substep, which may have
///                ended badly: nothing reads them
WEFT_KERNEL(add_pushed_lags, WEFT_GLOBAL const float4* standing,
            WEFT_GLOBAL const int* column_bodies, WEFT_GLOBAL const float* masses,
            WEFT_GLOBAL const float4* shifts, WEFT_GLOBAL const int* rows,
            WEFT_GLOBAL const int* counts, WEFT_GLOBAL const int* codes,
            WEFT_GLOBAL const float4* sides, WEFT_GLOBAL const float4* slips,
            WEFT_GLOBAL const float4* forces, WEFT_GLOBAL float4* partials, float friction,
            float creep, float h2, int has_moved, int column_count) {
    const integer own_body = load_index(column_bodies, i);
    const real4 left = load4(standing, i);
    body_sum sum = no_body_sum();
    sum.lag = xyz(left);
    if (has_moved) sum.lag = add_scaled(sum.lag, xyz(gather4(shifts, own_body)), -left.w);
    const real yielding = splat(h2) / gather(masses, own_body);
    sum = add_pushes_of_others(sum, shifts, has_moved, rows, counts, codes, sides, slips, forces, i,
                               own_body, yielding, friction, creep);
    const real4 part1 = {sum.block.xy, sum.block.xz, sum.block.yy, sum.block.yz};
    const real4 part2 = {sum.block.zz, sum.outside.xx, sum.outside.xy, sum.outside.xz};
    const real4 part3 = {sum.outside.yy, sum.outside.yz, sum.outside.zz, splat(0.0f)};
    store4(partials, i, with_w(sum.lag, sum.block.xx));
    store4(partials, column(i, column_count, 1), part1);
    store4(partials, column(i, column_count, 2), part2);
    store4(partials, column(i, column_count, 3), part3);
}

WEFT_INLINE body_sum load_body_sum(WEFT_GLOBAL const float4* lags, int lag_count, integer run) {
    const real4 a = gather4(lags, run);
    const real4 b = gather4(lags + lag_count, run);
    const real4 c = gather4(lags + 2 * lag_count, run);
    const real4 d = gather4(lags + 3 * lag_count, run);
    body_sum sum;
    sum.lag = xyz(a);
    sum.block = make_sym(a.w, b.x, b.y, b.z, b.w, c.x);
    sum.outside = make_sym(c.y, c.z, c.w, d.x, d.y, d.z);
    return sum;
}

/// How far each body has to go, as if it were the only one.
/// lags       [4 * lag_count] of the runs and more rows, column-major, see above
/// first_run  [bodies]
/// counts     [bodies] of its runs
/// masses     [bodies] [kg]
/// shifts     [bodies + 1] from those of the rounds before to those with this one: xyz [m]
/// rests      [3 * bodies] written, column-major: what this leaves to its group, and of what:
///            xyz [kg m], w: the mass, or 0 if it touches no other body [kg]; then the mass times
///            `outside`: xx, xy, xz, yy; and yz, zz
/// has_moved  as in add_pushed_lags
/// most_runs  that a body has; lag_count is that more than there are runs
WEFT_KERNEL(solve_bodies, WEFT_GLOBAL const float4* lags, WEFT_GLOBAL const int* first_run,
            WEFT_GLOBAL const float* counts, WEFT_GLOBAL const float* masses,
            WEFT_GLOBAL float4* shifts, WEFT_GLOBAL float4* rests, int has_moved, int most_runs,
            int lag_count, int body_count) {
    const real zero = splat(0.0f);
    body_sum sum = no_body_sum();
    const integer first = load_index(first_run, i);
    const real count = load(counts, i);
    for (int k = 0; k < most_runs; ++k) {
        const real own = splat((float)k) < count ? splat(1.0f) : zero;
        sum = add_share(sum, load_body_sum(lags + k, lag_count, first), own);
    }
    const real3 step = solve_sym(add_diagonal(sum.block, splat(1.0f)), sum.lag);
    const real mass = trace_sym(sum.block) > zero ? load(masses, i) : zero;
    const real3 left = subtract(subtract(sum.lag, step), multiply_sym(sum.outside, step));
    const sym3 outside = scale_sym(sum.outside, mass);
    const real4 rest1 = {outside.xx, outside.xy, outside.xz, outside.yy};
    const real4 rest2 = {outside.yz, outside.zz, zero, zero};
    real3 gone = step;
    if (has_moved) gone = add(step, xyz(load4(shifts, i)));
    store4(shifts, i, with_w(gone, zero));
    store4(rests, i, with_w(scale(left, mass), mass));
    store4(rests, column(i, body_count, 1), rest1);
    store4(rests, column(i, body_count, 2), rest2);
}

/// How far groups have to go then. A group's first body does it for all.
/// rests    [3 * bodies] as solve_bodies leaves them
/// firsts   [substeps * bodies] where a group's bodies begin in `members`
/// counts   [substeps * bodies] how many there are; 0 for all but the first one of a group
/// members  [substeps * bodies] groups side by side
/// shifts   [bodies] written: of the groups that begin there [m]
WEFT_KERNEL(solve_groups, WEFT_GLOBAL const float4* rests, WEFT_GLOBAL const int* firsts,
            WEFT_GLOBAL const int* counts, WEFT_GLOBAL const int* members,
            WEFT_GLOBAL float4* shifts, int body_count, int substep) {
    const real zero = splat(0.0f);
    const item now = column(i, body_count, substep);
    const whole first = load_whole(firsts, now);
    const whole count = load_whole(counts, now);
    const int longest = largest_whole(count);
    real3 left = make3(zero, zero, zero);
    sym3 block = diagonal_sym(zero);
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const whole place = on ? first + splat_whole(k) : first;
        const integer body = address(gather_whole(members + substep * body_count, address(place)));
        const real4 a = gather4(rests, body);
        const real4 b = gather4(rests + body_count, body);
        const real4 c = gather4(rests + 2 * body_count, body);
        const real own = on ? splat(1.0f) : zero;
        const sym3 outside = make_sym(b.x, b.y, b.z, b.w, c.x, c.y);
        left = add_scaled(left, xyz(a), own);
        block = add_sym(block, scale_sym(add_diagonal(outside, a.w), own));
    }
    store4(shifts, i, with_w(solve_sym(block, left), zero));
}

/// Adds what its group does to the step of each body that touches another one.
/// shifts   [bodies + 1] xyz [m]
/// leaders  [substeps * bodies] the first one of each body's group
/// others as in solve_groups
WEFT_KERNEL(add_groups, WEFT_GLOBAL float4* shifts, WEFT_GLOBAL const float4* rests,
            WEFT_GLOBAL const float4* group_shifts, WEFT_GLOBAL const int* leaders, int body_count,
            int substep) {
    const real zero = splat(0.0f);
    const integer leader = load_index(leaders, column(i, body_count, substep));
    const real touches = load4(rests, i).w > zero ? splat(1.0f) : zero;
    const real4 own = load4(shifts, i);
    store4(shifts, i,
           with_w(add_scaled(xyz(own), xyz(gather4(group_shifts, leader)), touches), zero));
}

WEFT_KERNELS_END

#endif
