#ifndef WEFT_KERNELS_XPBD_PAIR_H
#define WEFT_KERNELS_XPBD_PAIR_H

#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// Of two XPBD constraints of one element, which are projected together.
typedef struct {
    real first, second;
} real_pair;

/// The changes of both multipliers: (G + A) d = -(C + A lambda), where G = grad C M^-1 grad C^T and
/// A the diagonal matrix of both compliances, divided by h^2. One after the other, each constraint
/// would undo what the other one needs; together, an element at rest stays at rest. By elimination,
/// not by determinants: entries grow with the fifth power of an element's smallness, and products
/// of two of them overflow below a millimetre.
///
/// g_11, g_12, g_22  G, positive semi-definite
/// a_1, a_2          A, positive
/// r_1, r_2          C + A lambda
WEFT_INLINE real_pair solve_pair(real g_11, real g_12, real g_22, real a_1, real a_2, real r_1,
                                 real r_2) {
    const real inverse = splat(1.0f) / (g_11 + a_1);
    const real share = g_12 * inverse;
    // det G >= 0, so the pivot is not below this and A's, whatever the rounding.
    const real least = g_22 * (a_1 * inverse);
    const real pivot = larger(g_22 - share * g_12, least) + a_2;
    const real second = (share * r_1 - r_2) / pivot;
    real_pair d = {-r_1 * inverse - share * second, second};
    return d;
}

/// One over a strain: below 1e-6 it is made of rounding, and its gradient has no direction.
WEFT_INLINE real inverse_strain(real strain) { return splat(1.0f) / larger(strain, splat(1e-6f)); }

WEFT_KERNELS_END

#endif
