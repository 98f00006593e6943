#ifndef WEFT_KERNELS_JPGD_STEP_H
#define WEFT_KERNELS_JPGD_STEP_H

#include "kernels/descent/rows.h"
#include "kernels/jpgd/control.h"

WEFT_KERNELS_BEGIN

/// One preconditioned gradient step of every vertex, extrapolated by Chebyshev's weights:
///   x^ = x - alpha P^-1 dE/dx      x_next = x_before + w (x^ - x_before)
/// with P the vertex' 3x3 block of the Hessian. Wang and Yang 2016, algorithm 1.
/// positions   [vertices] x: xyz [m], w = 1/mass [1/kg]
/// next        [vertices] from x_before to x_next
/// targets     [vertices] xyz: x~ [m]
/// sums        [9 * vertices] g and H of all elements, H of an earlier iteration
/// control     see control.h
/// weights     [iterations] w of the n-th iteration after a start; 1 for n = 0
/// inverse_h2  1 / h^2 [1/s^2], h the substep
WEFT_KERNEL(step_preconditioned, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL float4* next,
            WEFT_GLOBAL const float4* targets, WEFT_GLOBAL const float* sums,
            WEFT_GLOBAL const float* control, WEFT_GLOBAL const float* weights, int vertex_count,
            float inverse_h2, int iteration) {
    const real4 x = load4(positions, i);
    const real3 before = xyz(load4(next, i));
    const slope s = load_slope(sums, i, vertex_count);

    const real inertia = inverse_h2 / (x.w > splat(0.0f) ? x.w : splat(1.0f));
    const real3 force =
        subtract(scale(subtract(xyz(load4(targets, i)), xyz(x)), inertia), s.gradient);
    const real alpha = x.w > splat(0.0f) ? splat(control[WEFT_STEP_SIZE]) : splat(0.0f);
    const real3 moved =
        add_scaled(xyz(x), solve_sym(add_diagonal(s.hessian, inertia), force), alpha);
    const float weight = weights[iteration - (int)control[WEFT_START]];
    // At a start there is nothing before.
    const real share = splat(weight - 1.0f);
    const real3 back = weight > 1.0f ? before : moved;
    store4(next, i, with_w(add_scaled(moved, subtract(moved, back), share), x.w));
}

WEFT_KERNELS_END

#endif
