#ifndef WEFT_KERNELS_SOSD_SINGLE_VERTICES_H
#define WEFT_KERNELS_SOSD_SINGLE_VERTICES_H

#include "kernels/sosd/stencil.h"

WEFT_KERNELS_BEGIN

/// Moves vertices that belong to no stencil, as solve_vertices does. For the parameters see
/// stencil.h.
WEFT_KERNEL(solve_single_vertices, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const float4* targets,
            WEFT_GLOBAL const int* vertices, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* sums, int stencil_count, int item_count, float inverse_h2) {
    const vertex_system v =
        load_system(positions, targets, vertices, sums, corner_items(corners, i, stencil_count, 0),
                    item_count, inverse_h2);
    move_vertex(positions, v, solve_sym(v.stiffness, v.force));
}

WEFT_KERNELS_END

#endif
