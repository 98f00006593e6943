#ifndef WEFT_KERNELS_CURVED_HINGE_WEIGHTS_H
#define WEFT_KERNELS_CURVED_HINGE_WEIGHTS_H

#include "kernels/energies/curved_hinge.h"
#include "kernels/platform.h"

WEFT_KERNELS_BEGIN

/// Row i of a table [6 * count] column-major: q_1, q_2, q_3, p_12, p_13, p_23
WEFT_INLINE curved_hinge load_curved_hinge(WEFT_GLOBAL const float* weights, item i, int count) {
    curved_hinge h = {load(weights, i),
                      load(weights, column(i, count, 1)),
                      load(weights, column(i, count, 2)),
                      load(weights, column(i, count, 3)),
                      load(weights, column(i, count, 4)),
                      load(weights, column(i, count, 5))};
    return h;
}

WEFT_KERNELS_END

#endif
