#ifndef WEFT_KERNELS_ENERGIES_SPRING_H
#define WEFT_KERNELS_ENERGIES_SPRING_H

// A spring, E = k/2 (|x0 - x1| - rest)^2. With d the unit vector from x1 to x0 and l the length:
//   dE/dx0 = k (l - rest) d                            dE/dx1 = -dE/dx0
//   d2E/dx0dx0 = k d d^T + k (1 - rest/l) (I - d d^T)  d2E/dx0dx1 = -d2E/dx0dx0
// A compressed spring's second term is negative; without it the matrix is positive semi-definite
// (Choi and Ko 2002). At l = 0 there is no direction: no force, and no stiffness.

#include "kernels/matrix.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// [J], for positions in [m] and k in [N/m]
WEFT_INLINE real spring_energy(real3 x0, real3 x1, real rest, real k) {
    const real error = length3(subtract(x0, x1)) - rest;
    return splat(0.5f) * k * error * error;
}

/// dE/dx0 [N]
WEFT_INLINE real3 spring_gradient(real3 x0, real3 x1, real rest, real k) {
    const real3 along = subtract(x0, x1);
    const real length = length3(along);
    return scale(along, k * ((length - rest) / divisor(length)));
}

/// k d d^T + across (I - d d^T)
WEFT_INLINE sym3 spring_stiffness(real3 direction, real k, real across) {
    return add_diagonal(outer_sym(direction, k - across), across);
}

/// d2E/dx0dx0 [N/m], projected to positive semi-definite
WEFT_INLINE sym3 spring_hessian(real3 x0, real3 x1, real rest, real k) {
    const real3 along = subtract(x0, x1);
    const real inverse = splat(1.0f) / divisor(length3(along));
    const real across = k * larger(splat(1.0f) - rest * inverse, splat(0.0f));
    return spring_stiffness(scale(along, inverse), k, across);
}

/// d2E/dx0dx0 [N/m] as it is: indefinite where the spring is compressed
WEFT_INLINE sym3 spring_exact_hessian(real3 x0, real3 x1, real rest, real k) {
    const real3 along = subtract(x0, x1);
    const real inverse = splat(1.0f) / divisor(length3(along));
    return spring_stiffness(scale(along, inverse), k, k * (splat(1.0f) - rest * inverse));
}

WEFT_KERNELS_END

#endif
