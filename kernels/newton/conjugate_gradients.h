#ifndef WEFT_KERNELS_NEWTON_CONJUGATE_GRADIENTS_H
#define WEFT_KERNELS_NEWTON_CONJUGATE_GRADIENTS_H

// Conjugate gradients for (M / h^2 + H) d = -dE/dx with a fixed number of steps, in the form of
// Chronopoulos and Gear (1989), in which both dot products of a step are added up at once:
//   u = P r      w = A u      gamma = r . u      delta = w . u
//   beta = gamma / gamma'     alpha = gamma / (delta - beta gamma / alpha')
//   p = u + beta p      s = w + beta s      d = d + alpha p      r = r - alpha s
// Every strip finds alpha and beta for itself, out of the same sums in the same order, so nobody
// waits for one who decides. A direction of no curvature, or what has no meaning, gives alpha = 0
// from then on: a value, no branch.
//
// vectors  p, s, d and w are [3 * vertices] column-major; r and u are float4, xyz

#include "kernels/descent/rows.h"
#include "kernels/in_order.h"
#include "kernels/newton/blocks.h"
#include "kernels/newton/holds.h"

// The dot products of a strip are summed in so many columns.
#define WEFT_DOT_COLUMNS 32

WEFT_KERNELS_BEGIN

/// factors  [6 * vertices] column-major: those of M / h^2 + H of each vertex (matrix.h); held
///          vertices have zeros, so nothing moves them
WEFT_INLINE sym3_factors load_factors(WEFT_GLOBAL const float* factors, item i, int count) {
    sym3_factors f;
    f.l_yx = load(factors, i);
    f.l_zx = load(factors, column(i, count, 1));
    f.l_zy = load(factors, column(i, count, 2));
    f.inverse_x = load(factors, column(i, count, 3));
    f.inverse_y = load(factors, column(i, count, 4));
    f.inverse_z = load(factors, column(i, count, 5));
    return f;
}

/// Starts from d = 0: the residual is the force, and the Jacobi blocks are factored.
/// positions   [vertices] xyz [m], w = 1/mass [1/kg]
/// targets     [vertices] xyz: x~ [m]
/// sums        [9 * vertices] g and H of all elements (descent/rows.h)
/// holds       [vertices] what holds each (holds.h); not read unless has_holds, as below
/// factors     written, see load_factors
/// residuals   written: r [N], w = 0
/// searches, applied, moves  written: zeros for p, s and d
WEFT_KERNEL(begin_conjugate_gradients, WEFT_GLOBAL const float4* positions,
            WEFT_GLOBAL const float4* targets, WEFT_GLOBAL const float* sums,
            WEFT_GLOBAL const float4* holds, WEFT_GLOBAL float* factors,
            WEFT_GLOBAL float4* residuals, WEFT_GLOBAL float* searches, WEFT_GLOBAL float* applied,
            WEFT_GLOBAL float* moves, int vertex_count, int has_holds, float inverse_h2) {
    const real zero = splat(0.0f);
    const real3 nothing = make3(zero, zero, zero);
    const real4 x = load4(positions, i);
    const derivatives sum = load_derivatives(sums, i, vertex_count);
    const real free = x.w > zero ? splat(1.0f) : zero;
    const real inertia = splat(inverse_h2) / (x.w > zero ? x.w : splat(1.0f));
    const sym3_factors f = factor_sym(add_diagonal(sum.hessian, inertia));
    store(factors, i, f.l_yx * free);
    store(factors, column(i, vertex_count, 1), f.l_zx * free);
    store(factors, column(i, vertex_count, 2), f.l_zy * free);
    store(factors, column(i, vertex_count, 3), f.inverse_x * free);
    store(factors, column(i, vertex_count, 4), f.inverse_y * free);
    store(factors, column(i, vertex_count, 5), f.inverse_z * free);
    real3 force = subtract(scale(subtract(xyz(load4(targets, i)), xyz(x)), inertia), sum.gradient);
    if (has_holds) force = held_back(force, load4(holds, i));
    store4(residuals, i, with_w(scale(force, free), zero));
    store_product(searches, i, vertex_count, nothing);
    store_product(applied, i, vertex_count, nothing);
    store_product(moves, i, vertex_count, nothing);
}

/// u = P r: the vertices' own blocks, and what the coarse space adds.
/// corrections    [aggregates + 1] xyz, zeros in the last one (coarse.h)
/// aggregates     [vertices] the aggregate of each vertex; held ones have the last
/// preconditioned  [vertices] written: u, w = 0
WEFT_KERNEL(precondition, WEFT_GLOBAL const float4* residuals, WEFT_GLOBAL const float* factors,
            WEFT_GLOBAL const float4* corrections, WEFT_GLOBAL const int* aggregates,
            WEFT_GLOBAL const float4* holds, WEFT_GLOBAL float4* preconditioned, int vertex_count,
            int has_holds) {
    const real3 own =
        solve_factored(load_factors(factors, i, vertex_count), xyz(load4(residuals, i)));
    const real3 coarse = xyz(gather4(corrections, load_index(aggregates, i)));
    real3 u = add(own, coarse);
    if (has_holds) u = held_back(u, load4(holds, i));
    store4(preconditioned, i, with_w(u, splat(0.0f)));
}

/// Adds the inertia to products = H u, and writes each vertex' part of both dot products.
/// products  [3 * vertices] from H u to w = A u
/// places    [vertices] of r . u in `terms`; those of one strip lie side by side
/// terms     written: r . u, and `delta_offset` behind it w . u
WEFT_KERNEL(finish_product, WEFT_GLOBAL const float4* positions,
            WEFT_GLOBAL const float4* residuals, WEFT_GLOBAL const float4* preconditioned,
            WEFT_GLOBAL const float4* holds, WEFT_GLOBAL float* products,
            WEFT_GLOBAL const int* places, WEFT_GLOBAL float* terms, int vertex_count,
            int delta_offset, int has_holds, float inverse_h2) {
    const real inverse_mass = load4(positions, i).w;
    const real inertia =
        splat(inverse_h2) / (inverse_mass > splat(0.0f) ? inverse_mass : splat(1.0f));
    const real3 u = xyz(load4(preconditioned, i));
    real3 w = add_scaled(load_product(products, i, vertex_count, 0), u, inertia);
    if (has_holds) w = held_back(w, load4(holds, i));
    store_product(products, i, vertex_count, w);
    const item gamma = {places[i.first], i.count};
    const item delta = {places[i.first] + delta_offset, i.count};
    store(terms, gamma, dot3(xyz(load4(residuals, i)), u));
    store(terms, delta, dot3(w, u));
}

/// Adds up the columns of a strip. Items are strips.
/// columns         [2 * WEFT_DOT_COLUMNS * strips] by strip: those of gamma, then of delta
/// first           [strips] where a strip's columns begin
/// gammas, deltas  [strips] written: the sums
WEFT_KERNEL(add_dot_columns, WEFT_GLOBAL const float* columns, WEFT_GLOBAL const int* first,
            WEFT_GLOBAL float* gammas, WEFT_GLOBAL float* deltas) {
    // One strip after the other: their columns lie apart.
    for (int lane = 0; lane < i.count; ++lane) {
        const int strip = i.first + lane;
        float gamma = 0.0f;
        float delta = 0.0f;
        WEFT_IN_ORDER
        for (int c = 0; c < WEFT_DOT_COLUMNS; ++c) {
            gamma += columns[first[strip] + c];
            delta += columns[first[strip] + WEFT_DOT_COLUMNS + c];
        }
        gammas[strip] = gamma;
        deltas[strip] = delta;
    }
}

/// Before the first step. scalars [strips] alpha, gamma, the gain so far, beta
WEFT_KERNEL(begin_steps, WEFT_GLOBAL float4* scalars) {
    const real zero = splat(0.0f);
    const real4 none = {zero, zero, zero, zero};
    store4(scalars, i, none);
}

/// alpha and beta, and by how much the model of E has fallen. Items are strips.
/// gammas, deltas  [strips] of all strips
/// scalars         [strips] of the step before; gamma: 0 before the first one, -1 when it is over
WEFT_KERNEL(find_step, WEFT_GLOBAL const float* gammas, WEFT_GLOBAL const float* deltas,
            WEFT_GLOBAL float4* scalars, int strip_count) {
    float gamma_sum = 0.0f;
    float delta_sum = 0.0f;
    WEFT_IN_ORDER
    for (int k = 0; k < strip_count; ++k) {
        gamma_sum += gammas[k];
        delta_sum += deltas[k];
    }
    const real zero = splat(0.0f);
    const real gamma = splat(gamma_sum);
    const real4 last = load4(scalars, i);
    const real has_last = last.y > zero ? splat(1.0f) : zero;
    const real beta = has_last * (gamma / (last.y > zero ? last.y : splat(1.0f)));
    const real drop = beta * gamma / (last.x > zero ? last.x : splat(1.0f));
    const real curvature = splat(delta_sum) - drop;
    const real is_good = last.y < zero ? zero : (gamma > zero ? splat(1.0f) : zero);
    const real divided = gamma / (curvature > zero ? curvature : splat(1.0f));
    // Neither overflow nor what came of one passes these comparisons.
    const real alpha = is_good > zero ? (curvature > zero ? divided : zero) : zero;
    const real is_finite = alpha < splat(1e30f) ? splat(1.0f) : zero;
    const real taken = is_finite > zero ? alpha : zero;
    const real kept = beta < splat(1e30f) ? beta : zero;
    const real4 now = {taken, taken > zero ? gamma : splat(-1.0f), last.z + taken * gamma,
                       taken > zero ? kept : zero};
    store4(scalars, i, now);
}

/// The vectors' part of a step.
/// scalars  [strips]; strips: [vertices] the strip of each vertex
WEFT_KERNEL(take_step, WEFT_GLOBAL const float4* scalars, WEFT_GLOBAL const int* strips,
            WEFT_GLOBAL const float4* preconditioned, WEFT_GLOBAL const float* products,
            WEFT_GLOBAL float* searches, WEFT_GLOBAL float* applied, WEFT_GLOBAL float* moves,
            WEFT_GLOBAL float4* residuals, int vertex_count) {
    const real4 step = gather4(scalars, load_index(strips, i));
    const real3 p = add_scaled(xyz(load4(preconditioned, i)),
                               load_product(searches, i, vertex_count, 0), step.w);
    const real3 s = add_scaled(load_product(products, i, vertex_count, 0),
                               load_product(applied, i, vertex_count, 0), step.w);
    store_product(searches, i, vertex_count, p);
    store_product(applied, i, vertex_count, s);
    store_product(moves, i, vertex_count,
                  add_scaled(load_product(moves, i, vertex_count, 0), p, step.x));
    store4(residuals, i, with_w(add_scaled(xyz(load4(residuals, i)), s, -step.x), splat(0.0f)));
}

WEFT_KERNELS_END

#endif
