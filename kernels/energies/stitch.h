#ifndef WEFT_KERNELS_ENERGIES_STITCH_H
#define WEFT_KERNELS_ENERGIES_STITCH_H

// A stitch of a seam: a spring (spring.h) whose rest length shrinks from the distance of its ends
// at the start to 0, at a constant rate, and stays there.

#include "kernels/energies/spring.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// [m]; start: the length at time 0 [m]; rate: one over the time that it takes to close [1/s]
WEFT_INLINE real stitch_rest(real start, real rate, float time) {
    return start * larger(splat(1.0f) - rate * splat(time), splat(0.0f));
}

WEFT_KERNELS_END

#endif
