#ifndef WEFT_KERNELS_SOSD_STENCIL_H
#define WEFT_KERNELS_SOSD_STENCIL_H

// Stencils of three or four vertices: a vertex system each, coupled by their own element.
//
// What the tables of stencils mean, for all kernels of this folder:
// corners        [corners * stencils] column-major: the items of each corner; neighbours for
//                neighbouring stencils
// stencil_count  rows of the stencils' tables
// All others are parameters of load_system(). Stencils of one call share no element.

#include "kernels/descent/vertex_system.h"

WEFT_KERNELS_BEGIN

/// The items at which a corner of stencils is.
WEFT_INLINE item corner_items(WEFT_GLOBAL const int* corners, item i, int stencil_count,
                              int corner) {
    const item at = {corners[i.first + corner * stencil_count], i.count};
    return at;
}

/// The blocks j < k of the element's d2E stand at k (k - 1) / 2 + j; those j > k are their
/// transposes, and those j = k are part of the corners' own stiffness.
typedef struct {
    vertex_system corner[4];
    mat3 coupling[6];
} stencil;

/// A vector at each corner.
typedef struct {
    real3 at[4];
} stencil_vector;

WEFT_INLINE stencil_vector multiply_stencil(stencil s, stencil_vector v, int corners) {
    stencil_vector product;
    for (int k = 0; k < corners; ++k) {
        product.at[k] = multiply_sym(s.corner[k].stiffness, v.at[k]);
        for (int j = 0; j < k; ++j) {
            const mat3 block = s.coupling[k * (k - 1) / 2 + j];
            product.at[j] = add(product.at[j], multiply_mat(block, v.at[k]));
            product.at[k] = add(product.at[k], multiply_transposed_mat(block, v.at[j]));
        }
    }
    return product;
}

/// a / b where that says something, else 0. Far below what moves a vertex by a rounding.
WEFT_INLINE real step_ratio(real a, real b) {
    const real least = splat(1e-36f);
    return b > least ? a / larger(b, least) : splat(0.0f);
}

/// dx of every corner, by a few steps of conjugate gradients with the corners' own stiffness as the
/// preconditioner: the element's coupling is a small part of what the elements around do, so these
/// steps leave next to nothing. The model's energy is lower after each of them. Held corners stand
/// still.
WEFT_INLINE stencil_vector solve_stencil(stencil s, int corners) {
    const int kSteps = 3;
    sym3_factors factors[4];
    stencil_vector moved, direction, residual;
    for (int k = 0; k < corners; ++k) {
        // Sums of many elements and one element's coupling are rounded differently; the system
        // stays positive where the one element is all there is.
        s.corner[k].stiffness =
            add_diagonal(s.corner[k].stiffness, trace_sym(s.corner[k].stiffness) * splat(1e-6f));
        factors[k] = factor_sym(s.corner[k].stiffness);
        residual.at[k] = s.corner[k].force;
        moved.at[k] = make3(splat(0.0f), splat(0.0f), splat(0.0f));
        direction.at[k] = moved.at[k];
    }
    real last = splat(0.0f);
    for (int step = 0; step < kSteps; ++step) {
        stencil_vector steepest;
        real descent = splat(0.0f);
        for (int k = 0; k < corners; ++k) {
            steepest.at[k] = scale(solve_factored(factors[k], residual.at[k]), s.corner[k].free);
            descent = descent + dot3(steepest.at[k], residual.at[k]);
        }
        const real kept = step_ratio(descent, last);
        for (int k = 0; k < corners; ++k) {
            direction.at[k] = add_scaled(steepest.at[k], direction.at[k], kept);
        }
        const stencil_vector applied = multiply_stencil(s, direction, corners);
        real curvature = splat(0.0f);
        for (int k = 0; k < corners; ++k) {
            curvature = curvature + dot3(direction.at[k], applied.at[k]);
        }
        const real length = step_ratio(descent, curvature);
        for (int k = 0; k < corners; ++k) {
            moved.at[k] = add_scaled(moved.at[k], direction.at[k], length);
            residual.at[k] = add_scaled(residual.at[k], applied.at[k], -length);
        }
        last = descent;
    }
    return moved;
}

WEFT_KERNELS_END

#endif
