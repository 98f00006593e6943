#ifndef WEFT_KERNELS_SOSD_WOVEN_H
#define WEFT_KERNELS_SOSD_WOVEN_H

#include "kernels/energies/woven.h"
#include "kernels/sosd/stencil.h"
#include "kernels/triangles.h"

WEFT_KERNELS_BEGIN

/// Moves the three vertices of each stencil, a triangle of woven cloth, towards the minimum of
/// their common quadratic model of E while all others stand still.
///
/// shape     [4 * stencils] column-major: b_1, b_2 [1/m]
/// material  [3 * stencils] column-major: warp, weft, shear stiffness, times the rest area [J]
///
/// For the others see stencil.h.
WEFT_KERNEL(solve_woven_stencils, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const float4* targets,
            WEFT_GLOBAL const int* vertices, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* shape, WEFT_GLOBAL const float* material,
            WEFT_GLOBAL const float* sums, int stencil_count, int item_count, float inverse_h2) {
    stencil s;
    for (int k = 0; k < 3; ++k) {
        s.corner[k] =
            load_system(positions, targets, vertices, sums,
                        corner_items(corners, i, stencil_count, k), item_count, inverse_h2);
    }
    const triangle_shape t = load_triangle_shape(shape, i, stencil_count);
    const woven w =
        make_woven(xyz(s.corner[0].x), xyz(s.corner[1].x), xyz(s.corner[2].x), t.b[1], t.b[2],
                   load(material, i), load(material, column(i, stencil_count, 1)),
                   load(material, column(i, stencil_count, 2)));
    for (int k = 1; k < 3; ++k) {
        for (int j = 0; j < k; ++j) {
            s.coupling[k * (k - 1) / 2 + j] = woven_coupling(w, t.b[j], t.b[k]);
        }
    }
    const stencil_vector step = solve_stencil(s, 3);
    for (int k = 0; k < 3; ++k) move_vertex(positions, s.corner[k], step.at[k]);
}

WEFT_KERNELS_END

#endif
