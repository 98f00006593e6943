#ifndef WEFT_KERNELS_CHOICE_H
#define WEFT_KERNELS_CHOICE_H

#include "kernels/lanes.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// a where m holds, else b.
WEFT_INLINE real3 either(mask m, real3 a, real3 b) {
    return make3(m ? a.x : b.x, m ? a.y : b.y, m ? a.z : b.z);
}

WEFT_KERNELS_END

#endif
