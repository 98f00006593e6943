#ifndef WEFT_KERNELS_COLUMNS_H
#define WEFT_KERNELS_COLUMNS_H

#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// A vector of each item, out of the columns k to k + 2 of a column-major table.
WEFT_INLINE real3 load3(WEFT_GLOBAL const float* p, item i, int rows, int k) {
    return make3(load(p, column(i, rows, k)), load(p, column(i, rows, k + 1)),
                 load(p, column(i, rows, k + 2)));
}

WEFT_KERNELS_END

#endif
