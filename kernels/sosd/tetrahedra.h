#ifndef WEFT_KERNELS_SOSD_TETRAHEDRA_H
#define WEFT_KERNELS_SOSD_TETRAHEDRA_H

#include "kernels/columns.h"
#include "kernels/energies/tetrahedron.h"
#include "kernels/sosd/stencil.h"

WEFT_KERNELS_BEGIN

/// Moves the four vertices of each stencil, a tetrahedron, towards the minimum of their common
/// quadratic model of E while all others stand still.
/// shape     [9 * stencils] column-major: b_1, b_2, b_3 [1/m]
/// material  [2 * stencils] column-major: mu, lambda, times the rest volume [J]
/// For the others see stencil.h.
WEFT_KERNEL(solve_tetrahedron_stencils, WEFT_GLOBAL float4* positions,
            WEFT_GLOBAL const float4* targets, WEFT_GLOBAL const int* vertices,
            WEFT_GLOBAL const int* corners, WEFT_GLOBAL const float* shape,
            WEFT_GLOBAL const float* material, WEFT_GLOBAL const float* sums, int stencil_count,
            int item_count, float inverse_h2) {
    stencil s;
    for (int k = 0; k < 4; ++k) {
        s.corner[k] =
            load_system(positions, targets, vertices, sums,
                        corner_items(corners, i, stencil_count, k), item_count, inverse_h2);
    }
    real3 b[4];
    b[1] = load3(shape, i, stencil_count, 0);
    b[2] = load3(shape, i, stencil_count, 3);
    b[3] = load3(shape, i, stencil_count, 6);
    b[0] = scale(add(add(b[1], b[2]), b[3]), splat(-1.0f));
    const mat3 map = tetrahedron_map(xyz(s.corner[0].x), xyz(s.corner[1].x), xyz(s.corner[2].x),
                                     xyz(s.corner[3].x), b[1], b[2], b[3]);
    const tetrahedron t =
        make_tetrahedron(map, load(material, i), load(material, column(i, stencil_count, 1)));
    for (int k = 1; k < 4; ++k) {
        for (int j = 0; j < k; ++j) {
            s.coupling[k * (k - 1) / 2 + j] = tetrahedron_coupling(t, b[j], b[k]);
        }
    }
    const stencil_vector step = solve_stencil(s, 4);
    for (int k = 0; k < 4; ++k) move_vertex(positions, s.corner[k], step.at[k]);
}

WEFT_KERNELS_END

#endif
