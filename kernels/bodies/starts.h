#ifndef WEFT_KERNELS_BODIES_STARTS_H
#define WEFT_KERNELS_BODIES_STARTS_H

// Where substeps of stiff bodies start. x~ has all that a body moves by, but strains what it turns
// and bends, and stiff elements make a hundred and more joules of that where gravity has given one;
// a few iterations leave a part of it, which throws the body about in the substeps that follow. The
// shape that the body had, moved as a whole to where E is least (held_bodies.h), is strained no
// more than it was, but knows nothing of how it bends. So a substep starts from the one of both
// where E is less, body by body. With d from the moved shape to x~ (less what was held up, see
// descent/substep.h), and g of elements there, E differs by
//
//   g . d / 2 + sum_v m_v / (2 h^2) (|x_v - x~_v|^2 - |y_v - x~_v|^2),    y = x - d
//
// but for what pulls in the moved shape already, which is small wherever this is large. Iterations
// that lead E down from there cannot end above the shape that there was, however few of them there
// are. Of what is not as stiff, iterations take back a good part of what x~ strains; there it has
// to be more than a part of the energy of motion beside the pins.
//
// What obstacles push, or others touch, is not moved as a whole: it starts from x~.

#include "kernels/bodies/held_bodies.h"

WEFT_KERNELS_BEGIN

/// How the vertex is led that a body is moved about; not at all where nothing holds that.
/// before, now  [vertices] xyz [m], w = 1/mass [1/kg]
/// ends     [2 * runs] as in find_hinges
/// carries  [runs + 1] written: xyz [m]
WEFT_KERNEL(find_carries, WEFT_GLOBAL const float4* before, WEFT_GLOBAL const float4* now,
            WEFT_GLOBAL const int* ends, WEFT_GLOBAL float4* carries) {
    const integer from = load_index(ends, i);
    const real zero = splat(0.0f);
    const real4 there = gather4(now, from);
    const real3 way = subtract(xyz(there), xyz(gather4(before, from)));
    const mask is_free = there.w > zero;
    store4(carries, i,
           with_w(make3(is_free ? zero : way.x, is_free ? zero : way.y, is_free ? zero : way.z),
                  zero));
}

/// How far the body of each run moves in a substep, from where it was.
/// carries  as find_carries leaves them
/// margins  [runs] which part of its energy of motion is a body's margin; below 0: it always starts
///          from x~
/// motions  as in solve_held; w of a shift: the margin
/// others   as in solve_held; pulls with what pins are led by beside that
WEFT_KERNEL(solve_starts, WEFT_GLOBAL const float4* sums, WEFT_GLOBAL const float4* pulls,
            WEFT_GLOBAL const int* first_run, WEFT_GLOBAL const float* counts,
            WEFT_GLOBAL const float4* hinges, WEFT_GLOBAL const float4* carries,
            WEFT_GLOBAL const float* numbers, WEFT_GLOBAL const float* margins,
            WEFT_GLOBAL float4* motions, int most_runs, int run_count) {
    const whole first = load_whole(first_run, i);
    moments m = sum_from_origin(sums, first, load(counts, i), most_runs);
    const hold all = sum_of_holds(pulls, first, load(counts, i), most_runs);
    const real3 carry = xyz(load4(carries, i));
    const real3 back = scale(carry, splat(-1.0f));
    m.lag = add(m.lag, back);
    m.lags = add_mat(m.lags, outer_mat(m.offset, back));
    const real3 line = xyz(load4(hinges, column(i, run_count, 1)));
    body_motion motion = motion_beside(m, all, line, numbers, run_count, i, 0.0f);
    motion.shift = add(motion.shift, carry);
    store_motion(motions, run_count + 1, i, motion);
    store4(motions, i, with_w(motion.shift, load(margins, i)));
    store4(motions, column(i, run_count + 1, 2), load4(hinges, i));
}

/// Where a vertex is once its body is moved from where it was.
/// motions  [3 * (runs + 1)] as solve_starts leaves them
WEFT_INLINE real3 moved_as_whole(real3 before, WEFT_GLOBAL const float4* motions, integer run,
                                 int run_count) {
    const real3 centre = xyz(gather4(motions + 2 * (run_count + 1), run));
    const body_motion motion = gather_motion(motions, run_count + 1, run);
    return add(before, way_of_motion(motion, subtract(before, centre)));
}

/// The run of a vertex; the last one plus 1 where it is in none.
/// bounds  [2 * runs] column-major: the first vertex of each, ascending, and the one behind its last
WEFT_INLINE integer run_of_vertex(WEFT_GLOBAL const int* bounds, int run_count, whole vertex) {
    whole run = splat_whole(0);
    for (int left = run_count; left > 1; left -= left / 2) {
        const whole middle = run + splat_whole(left / 2);
        run = vertex < gather_whole(bounds, address(middle)) ? run : middle;
    }
    const whole none = splat_whole(run_count);
    const whole before_end =
        vertex < gather_whole(bounds, address(run + splat_whole(run_count))) ? run : none;
    return address(vertex < gather_whole(bounds, address(run)) ? none : before_end);
}

/// By how much E is higher at the start than in the moved shape, and than the margin, vertex by
/// vertex.
/// positions  [vertices] xyz: the start [m], w = 1/mass [1/kg]
/// previous   [vertices] xyz: where bodies were [m]
/// targets    [vertices] xyz: x~ [m]
/// bounds     as in run_of_vertex
/// vertices   [items] the vertex of each
/// sums       [9 * items] gradients; see descent/rows.h
/// rises      [vertices] written [J]; 0 of what is held
WEFT_KERNEL(weigh_starts, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float4* previous,
            WEFT_GLOBAL const float4* targets, WEFT_GLOBAL const float4* motions,
            WEFT_GLOBAL const float4* carries, WEFT_GLOBAL const int* bounds,
            WEFT_GLOBAL const int* vertices, WEFT_GLOBAL const float* sums,
            WEFT_GLOBAL float* rises, int item_count, float inverse_h2, int run_count) {
    const integer v = load_index(vertices, i);
    const real4 x = gather4(positions, v);
    const real3 target = xyz(gather4(targets, v));
    const integer run = run_of_vertex(bounds, run_count, load_whole(vertices, i));
    const real3 before = xyz(gather4(previous, v));
    const real3 moved = moved_as_whole(before, motions, run, run_count);
    const real3 d = subtract(xyz(x), moved);
    const mask is_free = x.w > splat(0.0f);
    const real inertia = splat(inverse_h2) / (is_free ? x.w : splat(1.0f));
    const real3 both_off = add(subtract(xyz(x), target), subtract(moved, target));
    const real3 pull = add_scaled(load_gradient(sums, i, item_count), both_off, inertia);
    const real3 way = subtract(subtract(target, before), xyz(gather4(carries, run)));
    const real margin = gather4(motions, run).w * inertia * dot3(way, way);
    const mask all = splat(0.0f) < splat(1.0f);
    scatter_where(all, rises, v, is_free ? splat(0.5f) * (dot3(d, pull) - margin) : splat(0.0f));
}

/// Adds up vertices by columns.
/// rises     [vertices] [J]
/// members, shares, rows  see runs.h
/// partials  [columns] written: x
WEFT_KERNEL(add_rises, WEFT_GLOBAL const float* rises, WEFT_GLOBAL const int* members,
            WEFT_GLOBAL const float* shares, WEFT_GLOBAL const int* rows,
            WEFT_GLOBAL float4* partials) {
    const real zero = splat(0.0f);
    real sum = zero;
    const int length = rows[2 * i.first + 1];
    for (int k = 0; k < length; ++k) {
        const item entry = {rows[2 * i.first] + WEFT_RUN_COLUMNS * k, i.count};
        const real rise = gather(rises, load_index(members, entry));
        sum = sum + (load(shares, entry) > zero ? rise : zero);
    }
    store4(partials, i, with_w(make3(sum, zero, zero), zero));
}

/// Which bodies start from the moved shape.
/// rises      [runs + most_runs] x [J]
/// first_run, counts  as in solve_held
/// margins    as in solve_starts
/// touched    [runs] above 0 of what was pushed or touched in the substep before; not read unless
///            may_be_touched
/// chosen     [runs] written: 1, or 0
WEFT_KERNEL(choose_starts, WEFT_GLOBAL const float4* rises, WEFT_GLOBAL const int* first_run,
            WEFT_GLOBAL const float* counts, WEFT_GLOBAL const float* margins,
            WEFT_GLOBAL const float* touched, WEFT_GLOBAL float* chosen, int most_runs,
            int may_be_touched) {
    const real zero = splat(0.0f);
    const integer first = address(load_whole(first_run, i));
    const real count = load(counts, i);
    real sum = zero;
    for (int k = 0; k < most_runs; ++k) {
        const real rise = gather4(rises + k, first).x;
        sum = sum + (splat((float)k) < count ? rise : zero);
    }
    const real may = load(margins, i) < zero ? zero : splat(1.0f);
    const real touch = may_be_touched ? load(touched, i) : zero;
    const real free = touch > zero ? zero : may;
    // Written so that what is no number starts from x~.
    store(chosen, i, sum > zero ? free : zero);
}

/// Leads what has been chosen there, as move_held does.
/// positions  [vertices] xyz [m], w = 1/mass [1/kg]: to the start
/// runs       [columns] the run of each; columns of one run lie side by side
/// others     as in weigh_starts and choose_starts
WEFT_KERNEL(start_moved, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const float4* previous,
            WEFT_GLOBAL const float4* motions, WEFT_GLOBAL const float* chosen,
            WEFT_GLOBAL const int* members, WEFT_GLOBAL const float* shares,
            WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* runs, int run_count) {
    const int length = chosen[runs[i.first]] > 0.0f ? rows[2 * i.first + 1] : 0;
    const integer run = load_index(runs, i);
    for (int k = 0; k < length; ++k) {
        const item entry = {rows[2 * i.first] + WEFT_RUN_COLUMNS * k, i.count};
        const integer v = load_index(members, entry);
        const real3 moved = moved_as_whole(xyz(gather4(previous, v)), motions, run, run_count);
        scatter4_where(load(shares, entry) > splat(0.0f), positions, v,
                       with_w(moved, gather4(positions, v).w));
    }
}

/// Keeps which bodies are pushed or touched, for the next substep.
/// sums, first_run, counts  as in solve_held, behind the last iteration
/// touched  [runs] written: how much of it is
WEFT_KERNEL(keep_touched, WEFT_GLOBAL const float4* sums, WEFT_GLOBAL const int* first_run,
            WEFT_GLOBAL const float* counts, WEFT_GLOBAL float* touched, int most_runs) {
    const moments m = sum_from_origin(sums, load_whole(first_run, i), load(counts, i), most_runs);
    store(touched, i, m.pushed);
}

WEFT_KERNELS_END

#endif
