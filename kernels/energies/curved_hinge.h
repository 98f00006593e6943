#ifndef WEFT_KERNELS_ENERGIES_CURVED_HINGE_H
#define WEFT_KERNELS_ENERGIES_CURVED_HINGE_H

// Bending of two triangles that share an edge and are folded at rest by an angle t0: that of
// hinge.h with the fold t - t0 in the place of t. There b = -c L (u + v), for an edge of length L,
// with u and v the unit vectors across it, each in its triangle and linear in the corners. Here
// each of them is turned back about the edge e by half of t0 first:
//   b = -c L (cos(t0/2) (u + v) + sin(t0/2) e/L x (u - v))
// so b is quadratic in the corners, vanishes at rest in any place and position, and |b| = 2 c L
// |sin((t - t0)/2)| while the triangles keep their size: one rest state, whichever way it is
// folded. Nothing is divided by and no root is taken, so flat and collapsed triangles are nothing
// special. With all corners relative to one of them, y_j = x_j - x_0,
//   b = sum_j q_j y_j + sum_{j<k} p_jk y_j x y_k       E = 1/2 |b|^2
// Seen from any corner it has this form; its own weight is q_0 = -(q_1 + q_2 + q_3). With
//   v_0 = sum_{j<k} p_jk (y_k - y_j),     J_0 = db/dx_0 = q_0 I + [v_0]x
//   dE/dx_0 = J_0^T b = q_0 b + b x v_0
//   d2E/dx_0^2 = J_0^T J_0 = (q_0^2 + |v_0|^2) I - v_0 v_0^T
// which is the exact block (p_00 = 0), and positive semi-definite.

#include "kernels/matrix.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// Seen from one corner: weights of the three others [sqrt(J) / m] and of their pairs
/// [sqrt(J) / m^2]; the stiffness is part of them.
typedef struct {
    real q1, q2, q3;
    real p12, p13, p23;
} curved_hinge;

/// b [sqrt(J)]; y: the other corners, from this one [m]
WEFT_INLINE real3 curved_hinge_bend(curved_hinge h, real3 y1, real3 y2, real3 y3) {
    const real3 across = add_scaled(add_scaled(scale(y1, h.q1), y2, h.q2), y3, h.q3);
    const real3 twist = add_scaled(scale(cross3(y1, y2), h.p12), cross3(y1, y3), h.p13);
    return add(across, add_scaled(twist, cross3(y2, y3), h.p23));
}

/// q_0 [sqrt(J) / m]
WEFT_INLINE real curved_hinge_weight(curved_hinge h) { return -(h.q1 + h.q2 + h.q3); }

/// v_0 [sqrt(J) / m]
WEFT_INLINE real3 curved_hinge_spin(curved_hinge h, real3 y1, real3 y2, real3 y3) {
    const real3 first = add_scaled(scale(subtract(y2, y1), h.p12), subtract(y3, y1), h.p13);
    return add_scaled(first, subtract(y3, y2), h.p23);
}

/// dE/dx [N] of a corner with weight q and spin v
WEFT_INLINE real3 curved_hinge_gradient(real3 bend, real q, real3 v) {
    return add_scaled(cross3(bend, v), bend, q);
}

/// d2E/dx^2 [N/m] of a corner with weight q and spin v
WEFT_INLINE sym3 curved_hinge_hessian(real q, real3 v) {
    return add_diagonal(outer_sym(v, splat(-1.0f)), q * q + dot3(v, v));
}

/// The coupling d2E/dx_jdx_k [N/m] of two corners with weights and spins q_j, v_j and q_k, v_k, and
/// p_jk of theirs: J_j^T J_k - p_jk [b]x, exact; it may make the whole indefinite.
WEFT_INLINE mat3 curved_hinge_coupling(real3 bend, real q_j, real3 v_j, real q_k, real3 v_k,
                                       real p_jk) {
    const real3 twist = add_scaled(add_scaled(scale(v_k, q_j), v_j, -q_k), bend, -p_jk);
    // -[v_j]x [v_k]x = (v_j . v_k) I - v_k v_j^T
    const mat3 turned =
        add_diagonal_mat(outer_mat(scale(v_k, splat(-1.0f)), v_j), dot3(v_j, v_k) + q_j * q_k);
    return add_mat(turned, cross_mat(twist));
}

WEFT_KERNELS_END

#endif
