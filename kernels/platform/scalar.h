#pragma once

#include <cmath>

#include "kernels/platform/types.h"

#define WEFT_TARGET scalar
#define WEFT_REGISTER(kernel) register_scalar<kernel>()
// Other sources only name kernels, to launch them: what they would be compiled to there, with who
// knows which flags, is nobody's variant.
#ifdef WEFT_SCALAR_TARGET
#define WEFT_REGISTRATION(name) \
    inline const bool name##_is_registered = WEFT_REGISTER(name##_kernel);
#else
#define WEFT_REGISTRATION(name)
#endif
#define WEFT_NARROW_REGISTRATION WEFT_REGISTRATION

WEFT_KERNELS_BEGIN

inline constexpr int kLanes = 1;

using real = float;
using integer = int;

struct real4 {
    real x, y, z, w;
};

struct item {
    int first;
    int count;
};

WEFT_INLINE real splat(float value) { return value; }
WEFT_INLINE real square_root(real value) { return std::sqrt(value); }

WEFT_INLINE item column(item i, int rows, int k) { return {i.first + rows * k, i.count}; }

WEFT_INLINE real load(const float* p, item i) { return p[i.first]; }
WEFT_INLINE integer load_index(const int* p, item i) { return p[i.first]; }
WEFT_INLINE void store(float* p, item i, real value) { p[i.first] = value; }

WEFT_INLINE real4 gather4(const float4* p, integer k) { return {p[k].x, p[k].y, p[k].z, p[k].w}; }
WEFT_INLINE void scatter4(float4* p, integer k, real4 v) { p[k] = {v.x, v.y, v.z, v.w}; }
WEFT_INLINE real4 load4(const float4* p, item i) { return gather4(p, i.first); }
WEFT_INLINE void store4(float4* p, item i, real4 v) { scatter4(p, i.first, v); }

WEFT_KERNELS_END
