#ifndef WEFT_KERNELS_NEIGHBOURS_H
#define WEFT_KERNELS_NEIGHBOURS_H

// The smallest user of a table that changes from substep to substep (runtime/row_table.h), and the
// pattern for others: one kernel fills the rows, another one reads them.

#include "kernels/lanes.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

/// Rounds of part_neighbours, at the most.
#define WEFT_PARTING_ROUNDS 4

WEFT_KERNELS_BEGIN

/// For each point those that are nearer than the radius, in the order of their numbers, found by
/// looking at all of its range. How many there are does not depend on the table's size.
/// points      [items] xyz [m]
/// ranges      [2 * items] among which points: first, end; the same for all items of a strip
/// rows        [2 * items] column-major: where the row's entries start, how many there is room for
/// counts      [items] written: the entries that the row has
/// needs       [items] the most that a row should have had room for since instance 0
/// others      [entries] written: the other point
/// squares     [entries] written: the square of the distance [m^2]
/// radius      [m]
WEFT_NARROW_KERNEL(find_neighbours, WEFT_GLOBAL const float4* points, WEFT_GLOBAL const int* ranges,
                   WEFT_GLOBAL const int* rows, WEFT_GLOBAL int* counts, WEFT_GLOBAL int* needs,
                   WEFT_GLOBAL int* others, WEFT_GLOBAL float* squares, int item_count,
                   float radius, int instance) {
    const whole self = item_numbers(i);
    const whole start = load_whole(rows, i);
    const whole room = load_whole(rows, column(i, item_count, 1));
    const real3 x = xyz(load4(points, i));
    // A test of its own for x, so that all items at hand can pass over a point together.
    const real low = x.x - splat(radius);
    const real high = x.x + splat(radius);
    const float lowest = smallest_real(low);
    const float highest = largest_real(high);
    const int end = ranges[2 * i.first + 1];
    whole count = splat_whole(0);
    for (int j = ranges[2 * i.first]; j < end; ++j) {
        const float4 p = points[j];
        if (p.x <= lowest || p.x >= highest) continue;
        const real3 way = subtract(x, make3(splat(p.x), splat(p.y), splat(p.z)));
        const real square = dot3(way, way);
        const mask in_slab = both(low < splat(p.x), splat(p.x) < high);
        const mask is_other = self != splat_whole(j);
        const mask near = both(both(in_slab, is_other), square < splat(radius * radius));
        const mask fits = both(near, count < room);
        const integer entry = address(start + count * WEFT_ROW_STRIDE);
        scatter_whole_where(fits, others, entry, splat_whole(j));
        scatter_where(fits, squares, entry, square);
        count = near ? count + splat_whole(1) : count;
    }
    store_whole(counts, i, smaller_whole(count, room));
    store_whole(needs, i, instance == 0 ? count : larger_whole(count, load_whole(needs, i)));
}

/// Moves each point away from its neighbours as they were when these were found, by half of what
/// is missing on average; up to WEFT_PARTING_ROUNDS times, until none is nearer than 7/8 of the
/// radius.
/// positions   [items] xyz [m], w = 1/mass [1/kg]; read, and written where it changes
/// points, rows, counts, others, squares, radius  as in find_neighbours
WEFT_NARROW_KERNEL(part_neighbours, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const float4* points,
                   WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* counts,
                   WEFT_GLOBAL const int* others, WEFT_GLOBAL const float* squares, float radius) {
    const whole start = load_whole(rows, i);
    const whole count = load_whole(counts, i);
    const real4 before = load4(positions, i);
    const real one = splat(1.0f);
    real3 x = xyz(before);
    mask going = both(count > splat_whole(0), before.w > splat(0.0f));
    whole round = splat_whole(0);
    while (any_item(going)) {
        const int longest = largest_whole(count);
        real nearest = one;
        real weight = splat(0.0f);
        real3 push = make3(splat(0.0f), splat(0.0f), splat(0.0f));
        for (int k = 0; k < longest; ++k) {
            const mask on = splat_whole(k) < count;
            const integer entry = address(on ? start + splat_whole(k * WEFT_ROW_STRIDE) : start);
            const real3 p = xyz(gather4(points, address(gather_whole(others, entry))));
            const real3 way = subtract(x, p);
            const real part = length3(way) / splat(radius);
            // Those that were very near count less: nobody is thrown.
            const real ease = gather(squares, entry) / splat(radius * radius);
            const mask is_near = both(on, part < one);
            const real missing = is_near ? (one - part) * ease : splat(0.0f);
            push = add_scaled(push, way, missing);
            weight = weight + (on ? one : splat(0.0f));
            nearest = on ? smaller(nearest, part) : nearest;
        }
        const real step = splat(0.5f) / larger(weight, one);
        x.x = going ? x.x + push.x * step : x.x;
        x.y = going ? x.y + push.y * step : x.y;
        x.z = going ? x.z + push.z * step : x.z;
        round = going ? round + splat_whole(1) : round;
        going =
            both(going, both(nearest < splat(0.875f), round < splat_whole(WEFT_PARTING_ROUNDS)));
    }
    store4_where(round > splat_whole(0), positions, i, with_w(x, before.w));
}

WEFT_KERNELS_END

#endif
