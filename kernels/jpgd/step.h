#ifndef WEFT_KERNELS_JPGD_STEP_H
#define WEFT_KERNELS_JPGD_STEP_H

#include "kernels/descent/rows.h"
#include "kernels/jpgd/control.h"

WEFT_KERNELS_BEGIN

/// One preconditioned gradient step of every vertex, extrapolated by Chebyshev's weights:
///   x^ = x - alpha P^-1 dE/dx      x_next = x_before + w (x^ - x_before)
/// with P the vertex' 3x3 block of the Hessian. Wang and Yang 2016, algorithm 1.
///
/// The weights amplify whatever an iteration adds to the softest modes, and so the rounding of x.
/// What rounding takes from x is therefore kept beside it and added again in the next iteration, as
/// in Kahan's summation.
///
/// positions   [vertices] x: xyz [m], w = 1/mass [1/kg]
/// next        [vertices] xyz: x_before
/// residue        [vertices] xyz: what is missing in positions [m]
/// next_residue   [vertices] the same of next
/// targets     [vertices] xyz: x~ [m]
/// sums        [9 * vertices] g and H of all elements, H of an earlier iteration
/// control     see control.h
/// weights     [iterations] w of the n-th iteration after a start; 1 for n = 0
/// inverse_h2  1 / h^2 [1/s^2], h the substep
/// size        which part of the step is taken: alpha
/// accelerated    1, or 0 for a step of the vertex that is neither extrapolated nor summed up
WEFT_INLINE real3 preconditioned_move(
    WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float4* next,
    WEFT_GLOBAL const float4* residue, WEFT_GLOBAL const float4* next_residue,
    WEFT_GLOBAL const float4* targets, WEFT_GLOBAL const float* sums,
    WEFT_GLOBAL const float* control, WEFT_GLOBAL const float* weights, int vertex_count,
    float inverse_h2, int iteration, float size, real accelerated, item i) {
    const real4 x = load4(positions, i);
    const derivatives s = load_derivatives(sums, i, vertex_count);

    const real inertia = inverse_h2 / (x.w > splat(0.0f) ? x.w : splat(1.0f));
    const real3 force =
        subtract(scale(subtract(xyz(load4(targets, i)), xyz(x)), inertia), s.gradient);
    const real alpha = x.w > splat(0.0f) ? splat(size) : splat(0.0f);
    real3 move = scale(solve_sym(add_diagonal(s.hessian, inertia), force), alpha);
    const int turn = iteration - (int)control[WEFT_START];
    if (turn > 0) {
        const real3 missing = scale(xyz(load4(residue, i)), accelerated);
        real3 last = add(subtract(xyz(x), xyz(load4(next, i))), missing);
        // What a start begins from has none: it may have come back from a state that was not
        // finite.
        if (turn > 1) last = subtract(last, xyz(load4(next_residue, i)));
        const real share = splat(weights[turn] - 1.0f) * accelerated;
        move = add(missing, add_scaled(move, add(last, move), share));
    }
    return move;
}

/// Parameters as above; next and next_residue are written.
WEFT_KERNEL(step_preconditioned, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL float4* next,
            WEFT_GLOBAL const float4* residue, WEFT_GLOBAL float4* next_residue,
            WEFT_GLOBAL const float4* targets, WEFT_GLOBAL const float* sums,
            WEFT_GLOBAL const float* control, WEFT_GLOBAL const float* weights, int vertex_count,
            float inverse_h2, int iteration) {
    const real4 x = load4(positions, i);
    const real3 move = preconditioned_move(positions, next, residue, next_residue, targets, sums,
                                           control, weights, vertex_count, inverse_h2, iteration,
                                           control[WEFT_STEP_SIZE], splat(1.0f), i);
    const real3 sum = add(xyz(x), move);
    store4(next, i, with_w(sum, x.w));
    store4(next_residue, i, with_w(subtract(move, subtract(sum, xyz(x))), splat(0.0f)));
}

WEFT_KERNELS_END

#endif
