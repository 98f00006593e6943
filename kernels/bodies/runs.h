#ifndef WEFT_KERNELS_BODIES_RUNS_H
#define WEFT_KERNELS_BODIES_RUNS_H

// How free bodies are summed up. A run is the part of one body in one strip. Its vertices are
// summed in WEFT_RUN_COLUMNS columns, those in the order of columns, and the runs of a body in
// their order: one order on every device.
//
// What all sums over columns take:
// members  [entries] a vertex of the run; those of neighbouring columns are neighbours
// shares   [entries] its part of the body's mass; 0 where the run is shorter than its rows
// rows     [2 * columns] first entry, number of rows

#include "kernels/columns.h"
#include "kernels/lanes.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

#define WEFT_RUN_COLUMNS 64

WEFT_KERNELS_BEGIN

/// Adds up the columns of runs, one part of what they hold per item.
/// partials  [parts * columns] column-major
/// starts    [items] where the columns of each begin in `partials`
/// places    [items] where its sum belongs in `sums`
/// sums      [parts * sum_count] column-major; written for each run
WEFT_KERNEL(add_columns, WEFT_GLOBAL const float4* partials, WEFT_GLOBAL const int* starts,
            WEFT_GLOBAL const int* places, WEFT_GLOBAL float4* sums) {
    const real zero = splat(0.0f);
    const integer start = load_index(starts, i);
    real4 sum = {zero, zero, zero, zero};
    for (int k = 0; k < WEFT_RUN_COLUMNS; ++k) {
        const real4 column_sum = gather4(partials + k, start);
        sum = with_w(add(xyz(sum), xyz(column_sum)), sum.w + column_sum.w);
    }
    scatter4(sums, load_index(places, i), sum);
}

WEFT_KERNELS_END

#endif
