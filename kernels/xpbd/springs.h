#ifndef WEFT_KERNELS_XPBD_SPRINGS_H
#define WEFT_KERNELS_XPBD_SPRINGS_H

#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// Projects springs, E = k/2 (|x0 - x1| - rest)^2, as XPBD constraints C = |x0 - x1| - rest with
/// compliance 1/k: Macklin, Mueller and Chentanez 2016, equations 17 and 18.
/// positions    [vertices] xyz [m], w = 1/mass [1/kg]; read and written
/// ends         [2 * spring_count] column-major: the vertex at each end
/// material     [2 * spring_count] column-major: rest length [m], compliance [m/N]
/// multipliers  [spring_count] lambda [N s^2]; taken as 0 where `fresh`
/// inverse_h2   1 / h^2 [1/s^2], h the substep
/// fresh        1 in the first iteration of a substep, else 0
/// Springs of one call share no vertex.
WEFT_KERNEL(project_springs, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const int* ends,
            WEFT_GLOBAL const float* material, WEFT_GLOBAL float* multipliers, int spring_count,
            float inverse_h2, int fresh) {
    const integer end0 = load_index(ends, i);
    const integer end1 = load_index(ends, column(i, spring_count, 1));
    const real rest_length = load(material, i);
    const real compliance = load(material, column(i, spring_count, 1)) * inverse_h2;
    const real multiplier = fresh ? splat(0.0f) : load(multipliers, i);
    const real4 x0 = gather4(positions, end0);
    const real4 x1 = gather4(positions, end1);

    const real3 along = subtract(xyz(x0), xyz(x1));
    const real length = length3(along);
    const real error = length - rest_length;
    const real change = (-error - compliance * multiplier) / (x0.w + x1.w + compliance);
    const real push = change / divisor(length);

    store(multipliers, i, multiplier + change);
    scatter4(positions, end0, with_w(add_scaled(xyz(x0), along, push * x0.w), x0.w));
    scatter4(positions, end1, with_w(add_scaled(xyz(x1), along, -push * x1.w), x1.w));
}

WEFT_KERNELS_END

#endif
