#ifndef WEFT_KERNELS_ENERGIES_TRIANGLE_H
#define WEFT_KERNELS_ENERGIES_TRIANGLE_H

// A triangle of a thin sheet. Its shape at rest is given by the gradients b_1, b_2 [1/m] of the
// corners' barycentric coordinates in the plane; b_0 = -(b_1 + b_2). The columns of F (3x2) are the
// images of the plane's unit vectors u and v.

#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// A gradient in the sheet's plane at rest [1/m]
typedef struct {
    real u, v;
} real2;

WEFT_INLINE real2 make2(real u, real v) {
    real2 b = {u, v};
    return b;
}
WEFT_INLINE real dot2(real2 a, real2 b) { return a.u * b.u + a.v * b.v; }

WEFT_KERNELS_END

#endif
