#ifndef WEFT_KERNELS_TRIANGLES_H
#define WEFT_KERNELS_TRIANGLES_H

#include "kernels/energies/triangle.h"
#include "kernels/platform.h"

WEFT_KERNELS_BEGIN

/// b of the corners of a triangle at rest [1/m]
typedef struct {
    real2 b[3];
} triangle_shape;

/// shape  [4 * rows] column-major: b_1, b_2
WEFT_INLINE triangle_shape load_triangle_shape(WEFT_GLOBAL const float* shape, item i, int rows) {
    triangle_shape t;
    t.b[1] = make2(load(shape, i), load(shape, column(i, rows, 1)));
    t.b[2] = make2(load(shape, column(i, rows, 2)), load(shape, column(i, rows, 3)));
    t.b[0] = make2(-(t.b[1].u + t.b[2].u), -(t.b[1].v + t.b[2].v));
    return t;
}

WEFT_KERNELS_END

#endif
