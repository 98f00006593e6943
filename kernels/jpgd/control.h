#ifndef WEFT_KERNELS_JPGD_CONTROL_H
#define WEFT_KERNELS_JPGD_CONTROL_H

// The step size's rule: from time to time the energy decides whether the last steps were good.

#include "kernels/in_order.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

// What stands where in `control`.
#define WEFT_STEP_SIZE 0  // alpha; 0: stopped
#define WEFT_START 1      // the iteration in which Chebyshev's weights started
#define WEFT_ENERGY 2     // the lowest of a state that was kept in this substep [J]
#define WEFT_REVERT 3     // 1: back to the state that is kept
#define WEFT_LAST_SIZE 4  // alpha when it was last above 0
#define WEFT_CONTROL_SIZE 5

// An element with n <= 4 corners has a Hessian of at most n times its diagonal blocks. So such a
// step takes any mode of a quadratic E at most 1/3 beyond its minimum, and that is how far a step
// of time may miss it without feeding the mode: with x = p x~ from x~ = 2 x_t - x_(t-1), growth is
// |p +- sqrt(p^2 - p)|, at most 1 for p in [-1/3, 1].
#define WEFT_LARGEST_STEP 0.3333f

WEFT_KERNELS_BEGIN

/// Decides about the state after `iteration` iterations; only item 0 does so. Where the energy
/// rose, or is not finite: back, alpha *= 0.7, and Chebyshev's weights start anew; below 0.01 it
/// stops. alpha begins with 0.3 and grows by 1/0.7 in each substep (Wang and Yang 2016,
/// section 4.2); here only up to WEFT_LARGEST_STEP, and not where the last check of the substep
/// before was bad: with one check per substep it would be bad for ever.
///
/// control   [WEFT_CONTROL_SIZE] read and written
/// partials  [count] what the energy is the sum of, none negative [J]
/// slack     times the lowest energy so far is no rise yet: a little above 1 for the rounding, more
///           where obstacles do work
WEFT_KERNEL(decide_step, WEFT_GLOBAL float* control, WEFT_GLOBAL const float* partials, int count,
            float slack, int iteration) {
    if (i.first > 0) return;
    float energy = 0.0f;
    WEFT_IN_ORDER
    for (int k = 0; k < count; ++k) energy += partials[k];
    float size = control[WEFT_STEP_SIZE];
    float last = control[WEFT_LAST_SIZE];
    const int is_first = iteration == 0;
    if (is_first) {
        const float grown = control[WEFT_REVERT] > 0.0f ? last : last / 0.7f;
        last = last > 0.0f ? grown : 0.3f;
        last = last < WEFT_LARGEST_STEP ? last : WEFT_LARGEST_STEP;
        size = last;
    }
    // Written so that what is not finite counts as a rise.
    const float lowest = is_first ? energy : control[WEFT_ENERGY];
    const int is_good = is_first || energy <= lowest * slack;
    if (!is_good) {
        size = size * 0.7f;
        last = size > 0.0f ? size : last;
        size = size < 0.01f ? 0.0f : size;
    }
    const int starts = is_first || !is_good;
    const float start = starts ? (float)iteration : control[WEFT_START];
    control[WEFT_STEP_SIZE] = size;
    control[WEFT_START] = start;
    control[WEFT_ENERGY] = energy < lowest ? energy : lowest;
    control[WEFT_REVERT] = is_good ? 0.0f : 1.0f;
    control[WEFT_LAST_SIZE] = last;
}

/// Keeps a good state, or goes back to the one that was kept.
/// positions  [vertices] xyz [m], w = 1/mass
/// kept       [vertices]
WEFT_KERNEL(keep_or_revert, WEFT_GLOBAL float4* positions, WEFT_GLOBAL float4* kept,
            WEFT_GLOBAL const float* control) {
    if (control[WEFT_REVERT] > 0.0f)
        store4(positions, i, load4(kept, i));
    else
        store4(kept, i, load4(positions, i));
}

WEFT_KERNELS_END

#endif
