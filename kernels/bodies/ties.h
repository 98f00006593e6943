#ifndef WEFT_KERNELS_BODIES_TIES_H
#define WEFT_KERNELS_BODIES_TIES_H

// Where bodies that soft springs tie to others begin a substep. A stiff body on soft springs moves
// with them as a whole, by a force that few of its vertices feel: sweeps pass it on through the
// body an edge per iteration, and of what these few are moved, the stiff rest of the body takes
// back nearly all. So before the first iteration each part, a body without its ties, is led as a
// whole to where
//
//     |x - x~|^2_M / (2 h^2) + sum k/2 |end - goal|^2
//
// is least, round by round. The goal of a tie is where its rest length would be, in the direction
// that it has: no motion makes more of its energy than of this (Jensen). Ties of two parts count
// twice, as both move at once. The iterations that follow only have to strain the part.

#include "kernels/bodies/moments.h"
#include "kernels/energies/stitch.h"
#include "kernels/lanes.h"

#define WEFT_TIE_PARTS 4

WEFT_KERNELS_BEGIN

/// Where a part is held, in parts of its mass over h^2, with r from its centre.
typedef struct {
    real part;    ///< how stiffly
    real3 place;  ///< sum of r by that [m]
    sym3 spread;  ///< of r r^T [m^2]
} held_places;

typedef struct {
    body_motion pull;   ///< force [m], torque [m^2], in the same units
    held_places stiff;  ///< by ties
} tie_sum;

WEFT_INLINE tie_sum no_ties(void) {
    const real zero = splat(0.0f);
    tie_sum sum = {no_motion(), {zero, make3(zero, zero, zero), diagonal_sym(zero)}};
    return sum;
}

/// a + b * share
WEFT_INLINE held_places add_share_of_places(held_places a, held_places b, real share) {
    a.part = a.part + b.part * share;
    a.place = add_scaled(a.place, b.place, share);
    a.spread = add_sym(a.spread, scale_sym(b.spread, share));
    return a;
}

/// The form of motions, of the ways of what is there.
WEFT_INLINE sym6 form_of_places(held_places h) {
    const sym3 turned = scale_sym(h.spread, splat(-1.0f));
    const sym6 a = {diagonal_sym(h.part), lever_mat(h.place),
                    add_diagonal(turned, trace_sym(h.spread))};
    return a;
}

/// table  [4 * rows] column-major
WEFT_INLINE void store_ties(WEFT_GLOBAL float4* table, int rows, item i, tie_sum sum) {
    const sym3 s = sum.stiff.spread;
    store4(table, i, with_w(sum.pull.shift, s.xx));
    store4(table, column(i, rows, 1), with_w(sum.pull.turn, s.xy));
    store4(table, column(i, rows, 2), with_w(sum.stiff.place, sum.stiff.part));
    store4(table, column(i, rows, 3), with_w(make3(s.yy, s.yz, s.zz), s.xz));
}

/// All columns of a part: rows [first, first + WEFT_RUN_COLUMNS).
WEFT_INLINE tie_sum sum_of_columns(WEFT_GLOBAL const float4* table, int rows, integer first) {
    tie_sum sum = no_ties();
    for (int k = 0; k < WEFT_RUN_COLUMNS; ++k) {
        const real4 a = gather4(table + k, first);
        const real4 b = gather4(table + rows + k, first);
        const real4 c = gather4(table + 2 * rows + k, first);
        const real4 d = gather4(table + 3 * rows + k, first);
        sum.pull = add_scaled_motion(sum.pull, make_motion(xyz(a), xyz(b)), splat(1.0f));
        const held_places one = {c.w, xyz(c), make_sym(a.w, b.w, d.w, d.x, d.y, d.z)};
        sum.stiff = add_share_of_places(sum.stiff, one, splat(1.0f));
    }
    return sum;
}

/// Where a part's motion has led a vertex by now.
/// motions  [3 * (parts + 1)] column-major: the shift [m], the turn, the centre [m]
WEFT_INLINE real3 way_of_part(WEFT_GLOBAL const float4* motions, int part_count, integer part,
                              real3 x) {
    const real3 centre = xyz(gather4(motions + 2 * (part_count + 1), part));
    return way_of_motion(gather_motion(motions, part_count + 1, part), subtract(x, centre));
}

/// Before the first round.
/// sums     [9 * (parts + 1)] row-major: the moments of each part (moments.h)
/// first    [parts] its number
/// motions  as in way_of_part; written
WEFT_KERNEL(start_parts, WEFT_GLOBAL const float4* sums, WEFT_GLOBAL const int* first,
            WEFT_GLOBAL float4* motions, int part_count) {
    const moments m = sum_of_runs(sums, load_whole(first, i), splat(1.0f), 1);
    store_motion(motions, part_count + 1, i, no_motion());
    store4(motions, column(i, part_count + 1, 2), with_w(m.centre, splat(0.0f)));
}

/// What ties do to their parts, column by column.
/// positions  [vertices] xyz [m]
/// ends       [2 * entries] column-major: the vertex of the part, the other end
/// parts      [2 * entries] column-major: whose they are; part_count: of none
/// springs    [4 * entries] column-major: length at time 0 [m]; of which it loses so much per second
///            [1/s]; stiffness, in parts of the part's mass over h^2; the same that counts
/// rows       [2 * columns] first entry, number of rows; entries of neighbouring columns are
///            neighbours
/// motions    as in way_of_part
/// clock      [substeps] time at their ends [s]
/// partials   [4 * columns] written, column-major
WEFT_KERNEL(pull_parts, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* ends,
            WEFT_GLOBAL const int* parts, WEFT_GLOBAL const float* springs,
            WEFT_GLOBAL const int* rows, WEFT_GLOBAL const float4* motions,
            WEFT_GLOBAL const float* clock, WEFT_GLOBAL float4* partials, int entry_count,
            int part_count, int column_count, int substep) {
    tie_sum sum = no_ties();
    const int length = rows[2 * i.first + 1];
    for (int k = 0; k < length; ++k) {
        const item entry = {rows[2 * i.first] + WEFT_RUN_COLUMNS * k, i.count};
        const integer part = load_index(parts, entry);
        const real3 own = xyz(gather4(positions, load_index(ends, entry)));
        const real3 other =
            xyz(gather4(positions, load_index(ends, column(entry, entry_count, 1))));
        const real3 way = way_of_part(motions, part_count, part, own);
        const real3 other_way = way_of_part(
            motions, part_count, load_index(parts, column(entry, entry_count, 1)), other);
        const real3 gap = add(subtract(other, own), subtract(other_way, way));
        const real rest = stitch_rest(load(springs, entry),
                                      load(springs, column(entry, entry_count, 1)), clock[substep]);
        const real stiffness = load(springs, column(entry, entry_count, 2));
        const real3 pull = scale(gap, stiffness * (splat(1.0f) - rest / divisor(length3(gap))));
        const real3 place = add(own, subtract(way, xyz(gather4(motions, part))));
        const real3 lever = subtract(place, xyz(gather4(motions + 2 * (part_count + 1), part)));
        sum.pull = add_scaled_motion(sum.pull, make_motion(pull, cross3(lever, pull)), splat(1.0f));
        const held_places one = {splat(1.0f), lever, outer_sym(lever, splat(1.0f))};
        sum.stiff =
            add_share_of_places(sum.stiff, one, load(springs, column(entry, entry_count, 3)));
    }
    store_ties(partials, column_count, i, sum);
}

/// A round's step.
/// sums, first, motions  as in start_parts; adds to these
/// partials              as pull_parts leaves them
WEFT_KERNEL(step_parts, WEFT_GLOBAL const float4* sums, WEFT_GLOBAL const int* first,
            WEFT_GLOBAL const float4* partials, WEFT_GLOBAL float4* motions, int part_count,
            int column_count) {
    const whole part = load_whole(first, i);
    const moments m = sum_of_runs(sums, part, splat(1.0f), 1);
    const tie_sum ties =
        sum_of_columns(partials, column_count, address(part * splat_whole(WEFT_RUN_COLUMNS)));
    body_motion done =
        make_motion(xyz(load4(motions, i)), xyz(load4(motions, column(i, part_count + 1, 1))));
    const real3 force = add(subtract(m.lag, done.shift), ties.pull.shift);
    const real3 torque = add(lag_of_turn(m, done.turn), ties.pull.turn);
    const sym6 form = add_scaled_sym6(own_form_of(m), form_of_places(ties.stiff), splat(1.0f));
    done = add_scaled_motion(done, solve_sym6(form, make_motion(force, torque)), splat(1.0f));
    done.turn = bounded_turn(done.turn);
    store_motion(motions, part_count + 1, i, done);
}

/// positions  [vertices] xyz [m]; updated
/// vertices   [items] of parts
/// parts      [items] whose each is
/// motions    as in way_of_part
WEFT_KERNEL(move_parts, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const int* vertices,
            WEFT_GLOBAL const int* parts, WEFT_GLOBAL const float4* motions, int part_count) {
    const integer vertex = load_index(vertices, i);
    const real4 x = gather4(positions, vertex);
    const real3 way = way_of_part(motions, part_count, load_index(parts, i), xyz(x));
    scatter4(positions, vertex, with_w(add(xyz(x), way), x.w));
}

WEFT_KERNELS_END

#endif
