#ifndef HALVE_KERNELS_H
#define HALVE_KERNELS_H
#include <weft/kernel.h>

WEFT_KERNELS_IN(halve)

/// Weft's cloth has a kernel of this name, too.
WEFT_KERNEL(predict, WEFT_GLOBAL float* values, float factor) {
    store(values, i, load(values, i) * splat(factor) + splat(1.0f));
}

WEFT_KERNELS_END
#endif
