#ifndef WEFT_KERNELS_BODIES_MOMENTS_H
#define WEFT_KERNELS_BODIES_MOMENTS_H

// Where a free body's mass is, and where it should be: once per substep, behind its iterations, in
// parts of the body's mass. With r from the centre of mass, the inertia of its turns is
// tr(S) - S of S = mean of r r^T, and what is missing of its angular momentum is the mean of
// r x (x~ - x), or of (R r) x (x~ - x + r - R r) once it is turned by R: no single vertex is needed
// for that, but the mean of r (x~ - x)^T. All is summed up from a vertex of the body, as numbers
// are too coarse for squares of coordinates far from the origin.
#define WEFT_MOMENT_PARTS 9
/// Those that there are without pushes.
#define WEFT_STILL_PARTS 7

#include "kernels/bodies/motions.h"
#include "kernels/bodies/runs.h"

WEFT_KERNELS_BEGIN

typedef struct {
    real3 centre;  ///< mean of x [m]
    sym3 spread;   ///< of r r^T [m^2]
    real3 offset;  ///< of r [m]; the lag, x~ - x, of these here:
    real3 lag;     ///< [m]
    mat3 lags;     ///< r (x~ - x)^T [m^2]
    real3 push;    ///< of obstacles, by which they moved x~ [m]; 0 without any, as are those here
    real3 torque;  ///< of r x push [m^2]
    real3 way;     ///< that it has gone in the substep [m]
    real lead;     ///< of push . way: of what has been pushed [m^2]
    real pushed;   ///< of what obstacles have pushed
} moments;

WEFT_INLINE moments no_moments(void) {
    const real3 zero = no_motion().shift;
    moments m = {zero,
                 diagonal_sym(splat(0.0f)),
                 zero,
                 zero,
                 make_mat(zero, zero, zero),
                 zero,
                 zero,
                 zero,
                 splat(0.0f),
                 splat(0.0f)};
    return m;
}

WEFT_INLINE moments add_share_of_moments(moments a, moments b, real share) {
    a.centre = add_scaled(a.centre, b.centre, share);
    a.spread = add_sym(a.spread, scale_sym(b.spread, share));
    a.offset = add_scaled(a.offset, b.offset, share);
    a.lag = add_scaled(a.lag, b.lag, share);
    a.lags = make_mat(add_scaled(a.lags.x, b.lags.x, share), add_scaled(a.lags.y, b.lags.y, share),
                      add_scaled(a.lags.z, b.lags.z, share));
    a.push = add_scaled(a.push, b.push, share);
    a.torque = add_scaled(a.torque, b.torque, share);
    a.way = add_scaled(a.way, b.way, share);
    a.lead = a.lead + b.lead * share;
    a.pushed = a.pushed + b.pushed * share;
    return a;
}

/// table  [9 * rows] column-major: a column per part; the last two are those of pushes
WEFT_INLINE void store_moments(WEFT_GLOBAL float4* table, int rows, item i, moments m,
                               int has_pushes) {
    const real4 rest = {m.spread.xy, m.spread.xz, m.spread.yy, m.spread.yz};
    store4(table, i, with_w(m.centre, m.spread.xx));
    store4(table, column(i, rows, 1), rest);
    store4(table, column(i, rows, 2), with_w(m.offset, m.spread.zz));
    store4(table, column(i, rows, 3), with_w(m.lags.x, m.lag.x));
    store4(table, column(i, rows, 4), with_w(m.lags.y, m.lag.y));
    store4(table, column(i, rows, 5), with_w(m.lags.z, m.lag.z));
    store4(table, column(i, rows, 6), with_w(m.push, m.pushed));
    if (!has_pushes) return;
    store4(table, column(i, rows, 7), with_w(m.way, m.lead));
    store4(table, column(i, rows, 8), with_w(m.torque, splat(0.0f)));
}

/// The parts of row k, of which the next one is so many further.
WEFT_INLINE moments gather_moments(WEFT_GLOBAL const float4* table, int stride, integer k) {
    const real4 a = gather4(table, k);
    const real4 b = gather4(table + stride, k);
    const real4 c = gather4(table + 2 * stride, k);
    const real4 x = gather4(table + 3 * stride, k);
    const real4 y = gather4(table + 4 * stride, k);
    const real4 z = gather4(table + 5 * stride, k);
    moments m;
    m.centre = xyz(a);
    m.spread = make_sym(a.w, b.x, b.y, b.z, b.w, c.w);
    m.offset = xyz(c);
    m.lag = make3(x.w, y.w, z.w);
    m.lags = make_mat(xyz(x), xyz(y), xyz(z));
    const real4 push = gather4(table + 6 * stride, k);
    m.push = xyz(push);
    m.pushed = push.w;
    const real4 way = gather4(table + 7 * stride, k);
    m.way = xyz(way);
    m.lead = way.w;
    m.torque = xyz(gather4(table + 8 * stride, k));
    return m;
}

/// The part of one column.
/// positions  [vertices] xyz: x [m]
/// targets    [vertices] xyz: x~ [m], w: the grip, above 0 where obstacles have pushed the vertex
///            in this substep (obstacles/grip.h) [m], and with xpbd, whose bodies turn by themselves
/// previous, starts  [vertices] xyz: x and x~ before obstacles have pushed [m]; not read unless
///            has_pushes
/// members, shares, rows  see runs.h
/// origins   [columns] a vertex of the column's body, the same for all columns of it
/// partials  [9 * columns] written, column-major; 7 * columns unless has_pushes
WEFT_KERNEL(add_moments, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float4* targets,
            WEFT_GLOBAL const float4* previous, WEFT_GLOBAL const float4* starts,
            WEFT_GLOBAL const int* members, WEFT_GLOBAL const float* shares,
            WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* origins,
            WEFT_GLOBAL float4* partials, int has_pushes, int column_count) {
    const real3 origin = xyz(gather4(positions, load_index(origins, i)));
    moments sum = no_moments();
    const int length = rows[2 * i.first + 1];
    for (int k = 0; k < length; ++k) {
        const item entry = {rows[2 * i.first] + WEFT_RUN_COLUMNS * k, i.count};
        const integer v = load_index(members, entry);
        const real3 x = xyz(gather4(positions, v));
        const real3 r = subtract(x, origin);
        const real4 target = gather4(targets, v);
        const real3 lag = subtract(xyz(target), x);
        moments one = no_moments();
        one.centre = x;
        one.spread = outer_sym(r, splat(1.0f));
        one.offset = r;
        one.lag = lag;
        one.lags = outer_mat(r, lag);
        one.pushed = target.w > splat(0.0f) ? splat(1.0f) : splat(0.0f);
        if (has_pushes) {
            one.push = subtract(xyz(target), xyz(gather4(starts, v)));
            one.torque = cross3(r, one.push);
            one.way = subtract(x, xyz(gather4(previous, v)));
            one.lead = dot3(one.push, one.way);
        }
        sum = add_share_of_moments(sum, one, load(shares, entry));
    }
    store_moments(partials, column_count, i, sum, has_pushes);
}

/// The moments of a body, from the vertex that its columns begin at.
/// sums   [9 * (runs + most_runs)] row-major: the parts of a run follow each other
/// first  its first run
/// count  of its runs, most_runs at the most
WEFT_INLINE moments sum_from_origin(WEFT_GLOBAL const float4* sums, whole first, real count,
                                    int most_runs) {
    const integer start = address(first * splat_whole(WEFT_MOMENT_PARTS));
    moments sum = no_moments();
    for (int k = 0; k < most_runs; ++k) {
        const real own = splat((float)k) < count ? splat(1.0f) : splat(0.0f);
        sum =
            add_share_of_moments(sum, gather_moments(sums + WEFT_MOMENT_PARTS * k, 1, start), own);
    }
    return sum;
}

/// The same, from its centre of mass.
WEFT_INLINE moments sum_of_runs(WEFT_GLOBAL const float4* sums, whole first, real count,
                                int most_runs) {
    moments sum = sum_from_origin(sums, first, count, most_runs);
    const real3 back = scale(sum.offset, splat(-1.0f));
    sum.spread = add_sym(sum.spread, outer_sym(sum.offset, splat(-1.0f)));
    sum.lags = add_mat(sum.lags, outer_mat(back, sum.lag));
    sum.torque = add(sum.torque, cross3(back, sum.push));
    sum.offset = no_motion().shift;
    return sum;
}

/// Where what bears the body pushes it, friction and all.
WEFT_INLINE real3 up_of(moments m) { return scale(m.push, splat(1.0f) / divisor(length3(m.push))); }

/// What a body lacks where obstacles bear it.
typedef struct {
    real3 lag;   ///< [m]
    real share;  ///< of what obstacles have pushed it that is left out
} borne_lag;

/// What bears a body does not throw it. Obstacles push by what single vertices weigh alone, again
/// in each iteration, until what lies behind them has followed; after many iterations that are yet
/// too few, that may be more than the body needs. It may be led as far as what has been pushed has
/// got to, and all that would lead it further has not been pushed.
/// lag   how far its inertia leads the body from where it is, with all pushes [m]
/// gone  how far it has been moved since its moments were taken [m]
WEFT_INLINE borne_lag without_throw(real3 lag, moments m, real3 gone) {
    const real zero = splat(0.0f);
    const real3 up = up_of(m);
    const real across = larger(dot3(m.push, up), zero);
    const real shrink = splat(1.0f) / divisor(across);
    const real behind = m.lead * shrink - dot3(up, add(m.way, gone));
    const real excess = dot3(lag, up) - larger(behind, zero);
    const real left_out = larger(smaller(excess, across), zero);
    const borne_lag borne = {add_scaled(lag, m.push, -left_out * shrink), left_out * shrink};
    return borne;
}

/// Adds up the runs of each body.
/// sums               as in sum_of_runs
/// first_run, counts  [bodies]
/// moments_of         [9 * (bodies + 1)] written, column-major; of the last one nothing
WEFT_KERNEL(weigh_bodies, WEFT_GLOBAL const float4* sums, WEFT_GLOBAL const int* first_run,
            WEFT_GLOBAL const float* counts, WEFT_GLOBAL float4* moments_of, int most_runs,
            int body_count) {
    const moments sum = sum_of_runs(sums, load_whole(first_run, i), load(counts, i), most_runs);
    store_moments(moments_of, body_count + 1, i, sum, 1);
}

/// What turns of a body have to overcome [m^2], in parts of its mass. Where all of it lies on a
/// line or in a point, turns about that move nothing: a little is added, so that they stay finite.
WEFT_INLINE sym3 inertia_of(moments m) {
    const real size = trace_sym(m.spread);
    return add_diagonal(scale_sym(m.spread, splat(-1.0f)), size + splat(2e-5f) * size);
}

/// The form of inertia, in parts of the mass.
WEFT_INLINE sym6 own_form_of(moments m) {
    sym6 a = no_sym6();
    a.shift = diagonal_sym(splat(1.0f));
    a.turn = inertia_of(m);
    return a;
}

/// The mean of (R r - r) r^T, of the mean of r r^T.
WEFT_INLINE mat3 turned_ways(sym3 spread, real3 turn) {
    return make_mat(way_of_turn(turn, make3(spread.xx, spread.xy, spread.xz)),
                    way_of_turn(turn, make3(spread.xy, spread.yy, spread.yz)),
                    way_of_turn(turn, make3(spread.xz, spread.yz, spread.zz)));
}

/// The mean of (E r) r^T, likewise.
WEFT_INLINE mat3 strained_ways(sym3 spread, body_motion strain) {
    return make_mat(way_of_strain(strain, make3(spread.xx, spread.xy, spread.xz)),
                    way_of_strain(strain, make3(spread.xy, spread.yy, spread.yz)),
                    way_of_strain(strain, make3(spread.xz, spread.yz, spread.zz)));
}

/// What is missing of the angular momentum of a body that is turned already [m^2].
WEFT_INLINE real3 lag_of_turn(moments m, real3 turn) {
    const mat3 turned_lags = make_mat(way_of_turn(turn, m.lags.x), way_of_turn(turn, m.lags.y),
                                      way_of_turn(turn, m.lags.z));
    const mat3 turned = add_mat(turned_lags, turned_ways(m.spread, turn));
    return add(axis_of(m.lags), axis_of(turned));
}

WEFT_KERNELS_END

#endif
