#ifndef WEFT_KERNELS_CONTACT_QUIET_H
#define WEFT_KERNELS_CONTACT_QUIET_H

#include "kernels/contact/tilts.h"

WEFT_KERNELS_BEGIN

/// At a substep's end: which vertices went so far from where inertia led them that patches may have
/// folded which were taken for quiet (tilt_patches). Their neighbours were not looked at; the frame
/// has to be done again. One that cannot get farther than half of that from where it was need not
/// be looked at, as inertia led it no farther, either.
/// positions  [vertices] xyz [m]
/// anchors    [vertices] w: how far the vertex may get [m]
/// goals      [vertices] xyz: where inertia, or the scene, led it [m]
/// quiet      [vertices] the least `quiet` of its patches [m]
/// unquiet    [vertices] written: 1 where it did since instance 0, else 0
WEFT_KERNEL(find_unquiet, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float4* anchors,
            WEFT_GLOBAL const float4* goals, WEFT_GLOBAL const float* quiet,
            WEFT_GLOBAL int* unquiet, int instance) {
    const real limit = load(quiet, i);
    const real near_enough = splat(0.5f * WEFT_LOOSE_SHARE) * limit;
    const whole may_fold = load4(anchors, i).w < near_enough ? splat_whole(0) : splat_whole(1);
    whole now = splat_whole(0);
    if (any_item(may_fold > now)) {
        const real way = length3(subtract(xyz(load4(positions, i)), xyz(load4(goals, i))));
        // NaN is no way to stay.
        now = way <= splat(WEFT_LOOSE_SHARE) * limit ? now : may_fold;
    }
    store_whole(unquiet, i, instance == 0 ? now : larger_whole(now, load_whole(unquiet, i)));
}

WEFT_KERNELS_END

#endif
