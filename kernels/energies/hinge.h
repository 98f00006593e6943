#ifndef WEFT_KERNELS_ENERGIES_HINGE_H
#define WEFT_KERNELS_ENERGIES_HINGE_H

// Quadratic bending of two triangles that share an edge, flat at rest (Bergou et al. 2006):
// E = 1/2 |b|^2 with b = sum_j q_j x_j. Corners 0 and 1 are the edge's, 2 and 3 opposite it; the
// stiffness is part of the weights q_j [sqrt(J) / m], which add up to 0.
//   dE/dx_j = q_j b       d2E/dx_jdx_k = q_j q_k I, positive semi-definite and constant

#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// b [sqrt(J)], from edges rather than positions: so the rounding is that of the hinge's size, not
/// of its distance from the origin.
WEFT_INLINE real3 hinge_bend(real3 x0, real3 x1, real3 x2, real3 x3, real q1, real q2, real q3) {
    const real3 first = scale(subtract(x1, x0), q1);
    return add_scaled(add_scaled(first, subtract(x2, x0), q2), subtract(x3, x0), q3);
}

/// [J]
WEFT_INLINE real hinge_energy(real3 bend) { return splat(0.5f) * dot3(bend, bend); }

/// dE/dx_j [N] of the corner with weight q
WEFT_INLINE real3 hinge_gradient(real3 bend, real q) { return scale(bend, q); }

/// The factor of I in d2E/dx_jdx_k [N/m], for corners with weights q_j and q_k
WEFT_INLINE real hinge_hessian(real q_j, real q_k) { return q_j * q_k; }

WEFT_KERNELS_END

#endif
