#ifndef WEFT_KERNELS_XPBD_HINGES_H
#define WEFT_KERNELS_XPBD_HINGES_H

#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// Projects hinges, quadratic bending E = 1/2 |sum_j q_j x_j|^2 (Bergou et al. 2006; the stiffness
/// is part of q), as XPBD constraints C = |sum_j q_j x_j| with compliance 1.
/// positions    [vertices] xyz [m], w = 1/mass [1/kg]; read and written
/// corners      [4 * hinge_count] column-major: the edge's two vertices, the two opposite
/// weights      [4 * hinge_count] column-major: q of each corner [sqrt(J) / m]
/// multipliers  [hinge_count] lambda; taken as 0 where `fresh`
/// inverse_h2   1 / h^2 [1/s^2], h the substep
/// fresh        1 in the first iteration of a substep, else 0
/// Hinges of one call share no vertex.
WEFT_KERNEL(project_hinges, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* weights, WEFT_GLOBAL float* multipliers, int hinge_count,
            float inverse_h2, int fresh) {
    const integer c0 = load_index(corners, i);
    const integer c1 = load_index(corners, column(i, hinge_count, 1));
    const integer c2 = load_index(corners, column(i, hinge_count, 2));
    const integer c3 = load_index(corners, column(i, hinge_count, 3));
    const real q0 = load(weights, i);
    const real q1 = load(weights, column(i, hinge_count, 1));
    const real q2 = load(weights, column(i, hinge_count, 2));
    const real q3 = load(weights, column(i, hinge_count, 3));
    const real multiplier = fresh ? splat(0.0f) : load(multipliers, i);
    const real4 x0 = gather4(positions, c0);
    const real4 x1 = gather4(positions, c1);
    const real4 x2 = gather4(positions, c2);
    const real4 x3 = gather4(positions, c3);

    const real3 low = add_scaled(scale(xyz(x0), q0), xyz(x1), q1);
    const real3 high = add_scaled(scale(xyz(x2), q2), xyz(x3), q3);
    const real3 bend = add(low, high);
    const real error = length3(bend);
    const real mobility = (x0.w * q0 * q0 + x1.w * q1 * q1) + (x2.w * q2 * q2 + x3.w * q3 * q3);
    const real change = (-error - inverse_h2 * multiplier) / (mobility + inverse_h2);
    const real3 push = scale(bend, change / divisor(error));

    store(multipliers, i, multiplier + change);
    scatter4(positions, c0, with_w(add_scaled(xyz(x0), push, x0.w * q0), x0.w));
    scatter4(positions, c1, with_w(add_scaled(xyz(x1), push, x1.w * q1), x1.w));
    scatter4(positions, c2, with_w(add_scaled(xyz(x2), push, x2.w * q2), x2.w));
    scatter4(positions, c3, with_w(add_scaled(xyz(x3), push, x3.w * q3), x3.w));
}

WEFT_KERNELS_END

#endif
