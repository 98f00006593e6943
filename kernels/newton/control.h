#ifndef WEFT_KERNELS_NEWTON_CONTROL_H
#define WEFT_KERNELS_NEWTON_CONTROL_H

// What keeps Newton's steps from raising E: a state to go back to. All of it are values: the tasks
// are the same whatever happens.
//
// In `control` stand WEFT_STEP_SIZE, which limits the length of the next step, WEFT_ENERGY and
// WEFT_REVERT of jpgd/control.h.

#include "kernels/in_order.h"
#include "kernels/jpgd/control.h"
#include "kernels/newton/blocks.h"

WEFT_KERNELS_BEGIN

/// x = before + size d
/// before  [vertices] xyz [m], w = 1/mass [1/kg], 0 for held vertices
/// moves   [3 * vertices] column-major: d
WEFT_KERNEL(move_by_solution, WEFT_GLOBAL const float4* before, WEFT_GLOBAL const float* moves,
            WEFT_GLOBAL const float* control, WEFT_GLOBAL float4* positions, int vertex_count) {
    const real4 x = load4(before, i);
    const real size = x.w > splat(0.0f) ? splat(control[WEFT_STEP_SIZE]) : splat(0.0f);
    store4(positions, i,
           with_w(add_scaled(xyz(x), load_product(moves, i, vertex_count, 0), size), x.w));
}

/// Decides about the state after `iteration` iterations; only item 0 does so. Where E rose, or is
/// not finite: back, and the next step is a quarter as long. See also decide_step() of JPGD.
WEFT_KERNEL(decide_newton, WEFT_GLOBAL float* control, WEFT_GLOBAL const float* partials, int count,
            float slack, int iteration) {
    if (i.first > 0) return;
    float energy = 0.0f;
    WEFT_IN_ORDER
    for (int k = 0; k < count; ++k) energy += partials[k];
    const int is_first = iteration == 0;
    const float lowest = is_first ? energy : control[WEFT_ENERGY];
    // Written so that what is not finite counts as a rise.
    const int is_good = is_first || energy <= lowest * slack;
    const float size = is_first ? 1.0f : control[WEFT_STEP_SIZE];
    const float longer = size < 0.5f ? 2.0f * size : 1.0f;
    control[WEFT_STEP_SIZE] = is_good ? longer : 0.25f * size;
    control[WEFT_ENERGY] = energy < lowest ? energy : lowest;
    control[WEFT_REVERT] = is_good ? 0.0f : 1.0f;
}

WEFT_KERNELS_END

#endif
