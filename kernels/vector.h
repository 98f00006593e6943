#ifndef WEFT_KERNELS_VECTOR_H
#define WEFT_KERNELS_VECTOR_H

// Three-dimensional arithmetic on `real`. OpenCL C has no operators for structs, so these are
// words.

#include "kernels/platform.h"

WEFT_KERNELS_BEGIN

typedef struct {
    real x, y, z;
} real3;

WEFT_INLINE real3 make3(real x, real y, real z) {
    real3 v = {x, y, z};
    return v;
}

WEFT_INLINE real3 xyz(real4 a) { return make3(a.x, a.y, a.z); }

WEFT_INLINE real4 with_w(real3 a, real w) {
    real4 v = {a.x, a.y, a.z, w};
    return v;
}

WEFT_INLINE real3 add(real3 a, real3 b) { return make3(a.x + b.x, a.y + b.y, a.z + b.z); }
WEFT_INLINE real3 subtract(real3 a, real3 b) { return make3(a.x - b.x, a.y - b.y, a.z - b.z); }
WEFT_INLINE real3 scale(real3 a, real s) { return make3(a.x * s, a.y * s, a.z * s); }

/// a + b * s
WEFT_INLINE real3 add_scaled(real3 a, real3 b, real s) {
    return make3(a.x + b.x * s, a.y + b.y * s, a.z + b.z * s);
}

WEFT_INLINE real dot3(real3 a, real3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
WEFT_INLINE real3 cross3(real3 a, real3 b) {
    return make3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
WEFT_INLINE real length3(real3 a) { return square_root(dot3(a, a)); }

/// What of a way leads along a surface. normal: of length 1
WEFT_INLINE real3 along_surface(real3 way, real3 normal) {
    return add_scaled(way, normal, -dot3(way, normal));
}

WEFT_INLINE real smaller(real a, real b) { return a < b ? a : b; }
WEFT_INLINE real larger(real a, real b) { return a > b ? a : b; }
/// |a|
WEFT_INLINE real size_of(real a) { return larger(a, -a); }

/// A length to divide by: never 0, so a vector of length 0 stays 0 instead of becoming NaN.
WEFT_INLINE real divisor(real length) { return larger(length, splat(1e-20f)); }

WEFT_KERNELS_END

#endif
