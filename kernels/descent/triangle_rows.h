#ifndef WEFT_KERNELS_DESCENT_TRIANGLE_ROWS_H
#define WEFT_KERNELS_DESCENT_TRIANGLE_ROWS_H

#include "kernels/descent/rows.h"
#include "kernels/triangles.h"

WEFT_KERNELS_BEGIN

/// An entry of a vertex' row: a triangle, with the vertex as its corner 0.
typedef struct {
    real3 x1, x2;  ///< the other corners [m]
    triangle_shape shape;
} triangle_entry;

/// others  [2 * entries] column-major: the triangle's other vertices
/// shape   [4 * entries] column-major: their b [1/m]
WEFT_INLINE triangle_entry load_triangle(WEFT_GLOBAL const float4* positions,
                                         WEFT_GLOBAL const int* others,
                                         WEFT_GLOBAL const float* shape, item entry,
                                         int entry_count) {
    triangle_entry t;
    t.x1 = xyz(gather4(positions, load_index(others, entry)));
    t.x2 = xyz(gather4(positions, load_index(others, column(entry, entry_count, 1))));
    t.shape = load_triangle_shape(shape, entry, entry_count);
    return t;
}

WEFT_KERNELS_END

#endif
