#ifndef WEFT_KERNELS_TETRAHEDRA_H
#define WEFT_KERNELS_TETRAHEDRA_H

#include "kernels/columns.h"
#include "kernels/energies/tetrahedron.h"
#include "kernels/platform.h"

WEFT_KERNELS_BEGIN

/// An element as it is deformed.
/// corners   [4 * count] column-major
/// shape     [9 * count] column-major: b_1, b_2, b_3 [1/m]
/// material  [2 * count] column-major: mu, lambda, times the rest volume [J]
WEFT_INLINE tetrahedron load_deformed(WEFT_GLOBAL const float4* positions,
                                      WEFT_GLOBAL const int* corners,
                                      WEFT_GLOBAL const float* shape,
                                      WEFT_GLOBAL const float* material, item i, int count) {
    const real3 x0 = xyz(gather4(positions, load_index(corners, i)));
    const real3 x1 = xyz(gather4(positions, load_index(corners, column(i, count, 1))));
    const real3 x2 = xyz(gather4(positions, load_index(corners, column(i, count, 2))));
    const real3 x3 = xyz(gather4(positions, load_index(corners, column(i, count, 3))));
    const mat3 map = tetrahedron_map(x0, x1, x2, x3, load3(shape, i, count, 0),
                                     load3(shape, i, count, 3), load3(shape, i, count, 6));
    return make_tetrahedron(map, load(material, i), load(material, column(i, count, 1)));
}

WEFT_KERNELS_END

#endif
