#ifndef OWN_KERNELS_H
#define OWN_KERNELS_H

// Kernels as somebody else would write them.

#include <weft/kernel.h>

#include "tests/runtime/library/own_cell.h"

WEFT_KERNELS_IN(own)

/// A cell's heat goes to its neighbours; zones cool by what they give off.
/// now, next  [cells] next is written
/// losses     [zones], of an instance: row `instance` of it
WEFT_KERNEL(spread, WEFT_GLOBAL const Cell* now, WEFT_GLOBAL Cell* next,
            WEFT_GLOBAL const float* losses, int cells, float rate, int zones, int instance) {
    const whole number = item_numbers(i);
    const whole before = larger_whole(number - splat_whole(1), splat_whole(0));
    const whole behind = smaller_whole(number + splat_whole(1), splat_whole(cells - 1));
    const real here = load_member(now, i, heat);
    const real left = gather_member(now, address(before), heat);
    const real right = gather_member(now, address(behind), heat);
    const integer zone = load_index_member(now, i, zone);
    const real loss = gather(losses + zones * instance, zone);
    store_member(next, i, heat,
                 here + splat(rate) * (left - splat(2.0f) * here + right) - loss * here);
    store_member(next, i, flux, right - left);
}

WEFT_KERNELS_END

#endif
