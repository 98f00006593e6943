#ifndef WEFT_KERNELS_DESCENT_FREE_BODIES_H
#define WEFT_KERNELS_DESCENT_FREE_BODIES_H

// The momentum of bodies that nothing holds. At the minimum of E, internal forces add up to zero,
// so sum m (x - x~) = 0 for each such body; after a few sweeps it is not, and what is missing
// brakes a stiff body's fall like air. These kernels add it up and take it out, as one translation
// of the whole body: an energy of elements does not see it, and E falls by M |shift|^2 / (2 h^2).
//
// A run is the part of one free body in one strip. Its vertices are summed in WEFT_RUN_COLUMNS
// columns, those in the order of columns, and the runs of a body in their order: one order on every
// device.

#include "kernels/columns.h"
#include "kernels/lanes.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

#define WEFT_RUN_COLUMNS 64

WEFT_KERNELS_BEGIN

/// The part of one column in the mean of x~ - x over a body, weighted with the masses.
/// positions  [vertices] xyz: x [m]
/// targets    [vertices] xyz: x~ [m]
/// members    [entries] a vertex of the run; those of neighbouring columns are neighbours
/// shares     [entries] its part of the body's mass; 0 where the run is shorter than its rows
/// rows       [2 * columns] first entry, number of rows
/// partials   [columns] written: xyz [m], w = 0
WEFT_KERNEL(add_lags, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float4* targets,
            WEFT_GLOBAL const int* members, WEFT_GLOBAL const float* shares,
            WEFT_GLOBAL const int* rows, WEFT_GLOBAL float4* partials) {
    real3 sum = make3(splat(0.0f), splat(0.0f), splat(0.0f));
    const int length = rows[2 * i.first + 1];
    for (int k = 0; k < length; ++k) {
        const item entry = {rows[2 * i.first] + WEFT_RUN_COLUMNS * k, i.count};
        const integer v = load_index(members, entry);
        const real3 lag = subtract(xyz(gather4(targets, v)), xyz(gather4(positions, v)));
        sum = add_scaled(sum, lag, load(shares, entry));
    }
    store4(partials, i, with_w(sum, splat(0.0f)));
}

/// Adds up the columns of runs, one part of what they hold per item.
/// partials  [parts * columns] column-major
/// starts    [items] where the columns of each begin in `partials`
/// places    [items] where its sum belongs in `lags`
/// lags      [parts * lag_count] column-major; written for each run: of xyz alone [m], if there is
///           one part
WEFT_KERNEL(add_columns, WEFT_GLOBAL const float4* partials, WEFT_GLOBAL const int* starts,
            WEFT_GLOBAL const int* places, WEFT_GLOBAL float4* lags) {
    const real zero = splat(0.0f);
    const integer start = load_index(starts, i);
    real4 sum = {zero, zero, zero, zero};
    for (int k = 0; k < WEFT_RUN_COLUMNS; ++k) {
        const real4 column_sum = gather4(partials + k, start);
        sum = with_w(add(xyz(sum), xyz(column_sum)), sum.w + column_sum.w);
    }
    scatter4(lags, load_index(places, i), sum);
}

/// How far the body of each run has to go.
/// lags       [runs + most_runs] of the runs, and rows of zeros
/// first_run  [runs] the first one of the same body
/// counts     [runs] of that body's runs
/// shifts     [runs + 1] written: xyz [m]
/// most_runs  that a body has
WEFT_KERNEL(add_runs, WEFT_GLOBAL const float4* lags, WEFT_GLOBAL const int* first_run,
            WEFT_GLOBAL const float* counts, WEFT_GLOBAL float4* shifts, int most_runs) {
    const real zero = splat(0.0f);
    real3 sum = make3(zero, zero, zero);
    const integer first = load_index(first_run, i);
    const real count = load(counts, i);
    for (int k = 0; k < most_runs; ++k) {
        const real own = splat((float)k) < count ? splat(1.0f) : zero;
        sum = add_scaled(sum, xyz(gather4(lags + k, first)), own);
    }
    store4(shifts, i, with_w(sum, zero));
}

/// Moves a vertex, and its velocity by as much per substep: to that nothing is lost by rounding,
/// whereas a way may be too small for a coordinate. Parameters as in shift_bodies.
WEFT_INLINE void shift_vertex(WEFT_GLOBAL float4* positions, WEFT_GLOBAL float4* deviations,
                              WEFT_GLOBAL float4* velocities, item i, real3 way, float inverse_h) {
    const real4 x = load4(positions, i);
    const real4 deviation = load4(deviations, i);
    const real4 v = load4(velocities, i);
    store4(positions, i, with_w(add(xyz(x), way), x.w));
    store4(deviations, i, with_w(add(xyz(deviation), way), deviation.w));
    store4(velocities, i, with_w(add_scaled(xyz(v), way, v.w * splat(inverse_h)), v.w));
}

/// Moves the vertices of free bodies.
/// positions   [vertices] xyz [m]
/// deviations  [vertices] xyz: x - x~ [m]
/// velocities  [vertices] xyz [m/s], w = what damping leaves per substep
/// shifts      [runs + 1] xyz [m]; the last one is zero
/// runs        [vertices] the run of each vertex; the last one for those that something holds
/// inverse_h   1 / h [1/s], h the substep
WEFT_KERNEL(shift_bodies, WEFT_GLOBAL float4* positions, WEFT_GLOBAL float4* deviations,
            WEFT_GLOBAL float4* velocities, WEFT_GLOBAL const float4* shifts,
            WEFT_GLOBAL const int* runs, float inverse_h) {
    const real3 shift = xyz(gather4(shifts, load_index(runs, i)));
    shift_vertex(positions, deviations, velocities, i, shift, inverse_h);
}

/// Adds what obstacles pushed to the velocities.
/// positions   [vertices] xyz behind the pushes [m]
/// pushed      [vertices] xyz before them
/// velocities  [vertices] xyz [m/s], w = what damping leaves per substep
WEFT_KERNEL(push_velocities, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float4* pushed,
            WEFT_GLOBAL float4* velocities, float inverse_h) {
    const real3 push = subtract(xyz(load4(positions, i)), xyz(load4(pushed, i)));
    const real4 v = load4(velocities, i);
    store4(velocities, i, with_w(add_scaled(xyz(v), push, v.w * splat(inverse_h)), v.w));
}

WEFT_KERNELS_END

#endif
