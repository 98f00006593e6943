#ifndef WEFT_KERNELS_CONTACT_RISING_H
#define WEFT_KERNELS_CONTACT_RISING_H

// A substep starts from x~ less that part of the fall which was held up in the one before
// (descent/substep.h). A few iterations leave most of what is slow as they found it there, so of
// slow motions that start is the force, and it is late: by a substep and more. A force that is late
// takes from what falls onto it, and gives to what rises off it. Of piles of sheets it gave so much
// that they swelled, and threw their uppermost sheets up. So what rises off its contacts is not
// held up by them: by so much less as it rises fast, and not at all from the speed on that gravity
// gives in a substep. What elements hold up stays: that is what the start is for, as iterations do
// not carry a load through a sheet to where it hangs.

#include "kernels/contact/rows.h"

WEFT_KERNELS_BEGIN

/// Which part of a vertex' weight its contacts bear, from 0 to 1.
/// pull     gravity [m/s^2], times inverse mass, per square of gravity: [s^2/(m kg)]
/// others   as in gather_contacts
WEFT_INLINE real borne_part(WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* corner0,
                            WEFT_GLOBAL const int* corner1, WEFT_GLOBAL const int* corner2,
                            WEFT_GLOBAL const int* corner3, WEFT_GLOBAL const float4* normals,
                            WEFT_GLOBAL const float4* weights, WEFT_GLOBAL const float4* measures,
                            whole start, whole count, real3 pull) {
    const int longest = largest_whole(count);
    real sum = splat(0.0f);
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
        const contact_entry c = load_contact(positions, corner0, corner1, corner2, corner3, normals,
                                             weights, measures, entry);
        const real lift = -press_of_gap(c) * c.own * dot3(c.normal, pull);
        sum = on ? sum + lift : sum;
    }
    return smaller(larger(sum, splat(0.0f)), splat(1.0f));
}

/// Takes what contacts bear of those that rise out of what the next substep starts with. Over all
/// vertices.
/// velocities  [vertices] xyz [m/s]
/// targets     [vertices] xyz: x - x~ [m], made less
/// gravity     [substeps] xyz [m/s^2]
/// h           the substep [s]
/// substep     of the frame
/// others as in gather_contacts (rows.h)
WEFT_NARROW_KERNEL(let_rise, WEFT_GLOBAL const float4* positions,
                   WEFT_GLOBAL const float4* velocities, WEFT_GLOBAL const int* rows,
                   WEFT_GLOBAL const int* counts, WEFT_GLOBAL const int* corner0,
                   WEFT_GLOBAL const int* corner1, WEFT_GLOBAL const int* corner2,
                   WEFT_GLOBAL const int* corner3, WEFT_GLOBAL const float4* normals,
                   WEFT_GLOBAL const float4* weights, WEFT_GLOBAL const float4* measures,
                   WEFT_GLOBAL float4* targets, WEFT_GLOBAL const float4* gravity, float h,
                   int substep) {
    const float4 g = gravity[substep];
    const float square = g.x * g.x + g.y * g.y + g.z * g.z;
    const float inverse = square > 0.0f ? 1.0f / square : 0.0f;
    const real4 v = load4(velocities, i);
    const real rising = -(v.x * g.x + v.y * g.y + v.z * g.z) * splat(inverse / h);
    const real fast = smaller(larger(rising, splat(0.0f)), splat(1.0f));
    const whole count = load_whole(counts, i);
    const mask rises = both(count > splat_whole(0), rising > splat(0.0f));
    if (!any_item(rises)) return;
    const real per = load4(positions, i).w * splat(inverse);
    const real3 pull = make3(splat(g.x) * per, splat(g.y) * per, splat(g.z) * per);
    const real borne = borne_part(positions, corner0, corner1, corner2, corner3, normals, weights,
                                  measures, load_whole(rows, i), count, pull);
    const real4 held = load4(targets, i);
    const real kept = rises ? splat(1.0f) - fast * borne : splat(1.0f);
    store4(targets, i, with_w(scale(xyz(held), kept), held.w));
}

WEFT_KERNELS_END

#endif
