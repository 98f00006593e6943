#pragma once

#include <cmath>

#include "kernels/platform/types.h"

// The arithmetic of the language in double precision: for the reference solver and for tests by
// finite differences, which so use the very definitions that the kernels use. A source asks for it
// by defining WEFT_IN_DOUBLE before its first kernel header. There are values only, neither items
// nor memory: headers of element functions compile (kernels/energies/), and of kernels in the same
// header, a template remains that nobody instantiates (kernels/obstacles/).
#define WEFT_TARGET in_double
#undef WEFT_KERNEL
#define WEFT_KERNEL(name, ...) \
    template <class item>      \
    void name(item i, __VA_ARGS__)

WEFT_KERNELS_BEGIN

using real = double;
using integer = int;

struct real4 {
    real x, y, z, w;
};

WEFT_INLINE real splat(float value) { return static_cast<real>(value); }
WEFT_INLINE real square_root(real value) { return std::sqrt(value); }
WEFT_INLINE bool any_item(bool mask) { return mask; }

WEFT_KERNELS_END
