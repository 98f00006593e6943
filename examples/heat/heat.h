#ifndef HEAT_H
#define HEAT_H
#include <weft/kernel.h>

WEFT_KERNELS_IN(heat)

/// One step of the heat equation, explicitly: next = now + rate * (its four neighbours - 4 now).
/// now, next  [cells] a grid, row by row; next is written
/// rate       [cells] conductivity * time step / spacing^2; 0 where the heat is given
/// width      cells per row
WEFT_KERNEL(diffuse, WEFT_GLOBAL const float* now, WEFT_GLOBAL float* next,
            WEFT_GLOBAL const float* rate, int width) {
    const real here = load(now, i);
    const real beside = load(now, column(i, 1, -1)) + load(now, column(i, 1, 1));
    const real above_and_below = load(now, column(i, width, -1)) + load(now, column(i, width, 1));
    store(next, i, here + load(rate, i) * (beside + above_and_below - splat(4.0f) * here));
}

WEFT_KERNELS_END
#endif
