#ifndef WEFT_KERNELS_XPBD_STITCHES_H
#define WEFT_KERNELS_XPBD_STITCHES_H

#include "kernels/columns.h"
#include "kernels/energies/stitch.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// Projects stitches (energies/stitch.h) as XPBD constraints, as project_springs() does with
/// springs.
/// ends         [2 * count] column-major: the vertex at each end
/// material     [3 * count] column-major: length at the start [m], compliance [m/N], rate [1/s]
/// clock        [substeps] time at each substep's end [s]; instance: which substep
/// The others as in project_springs. Stitches of one call share no vertex.
WEFT_KERNEL(project_stitches, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const int* ends,
            WEFT_GLOBAL const float* material, WEFT_GLOBAL const float* clock,
            WEFT_GLOBAL float* multipliers, int count, float inverse_h2, int fresh, int instance) {
    const integer end0 = load_index(ends, i);
    const integer end1 = load_index(ends, column(i, count, 1));
    const real rest =
        stitch_rest(load(material, i), load(material, column(i, count, 2)), clock[instance]);
    const real compliance = load(material, column(i, count, 1)) * inverse_h2;
    const real multiplier = fresh ? splat(0.0f) : load(multipliers, i);
    const real4 x0 = gather4(positions, end0);
    const real4 x1 = gather4(positions, end1);

    const real3 along = subtract(xyz(x0), xyz(x1));
    const real length = length3(along);
    const real change = (rest - length - compliance * multiplier) / (x0.w + x1.w + compliance);
    const real push = change / divisor(length);

    store(multipliers, i, multiplier + change);
    scatter4(positions, end0, with_w(add_scaled(xyz(x0), along, push * x0.w), x0.w));
    scatter4(positions, end1, with_w(add_scaled(xyz(x1), along, -push * x1.w), x1.w));
}

WEFT_KERNELS_END

#endif
