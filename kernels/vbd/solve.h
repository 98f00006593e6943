#ifndef WEFT_KERNELS_VBD_SOLVE_H
#define WEFT_KERNELS_VBD_SOLVE_H

#include "kernels/descent/vertex_system.h"

WEFT_KERNELS_BEGIN

/// Moves each vertex to the minimum of its quadratic model of E while all others stand still:
/// (m/h^2 I + H) dx = m/h^2 (x~ - x) - g. Chen et al. 2024 (VBD), equations 9 to 12.
/// Parameters as in load_system(); the positions are written, too. Vertices of one call share no
/// element.
WEFT_KERNEL(solve_vertices, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const float4* targets,
            WEFT_GLOBAL const int* vertices, WEFT_GLOBAL const float* sums, int item_count,
            float inverse_h2) {
    const vertex_system v =
        load_system(positions, targets, vertices, sums, i, item_count, inverse_h2);
    move_vertex(positions, v, solve_sym(v.stiffness, v.force));
}

WEFT_KERNELS_END

#endif
