#ifndef WEFT_KERNELS_CONTACT_QUIET_H
#define WEFT_KERNELS_CONTACT_QUIET_H

#include "kernels/contact/tilts.h"

WEFT_KERNELS_BEGIN

/// At a substep's end: which vertices went so far from where inertia led them that patches may have
/// folded which were taken for quiet (tilt_patches). Their neighbours were not looked at; the frame
/// has to be done again. Vertices that may not get far anyhow need no looking at.
/// positions  [vertices] xyz [m]
/// anchors    [vertices] w: how far the vertex may get [m]
/// goals      [vertices] xyz: where inertia, or the scene, led it [m]
/// quiet      [vertices] the least `quiet` of its patches [m]
/// unquiet    [vertices] written: 1 where it did since instance 0, else 0
WEFT_KERNEL(find_unquiet, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float4* anchors,
            WEFT_GLOBAL const float4* goals, WEFT_GLOBAL const float* quiet,
            WEFT_GLOBAL int* unquiet, int instance) {
    const real limit = load(quiet, i);
    const real way = length3(subtract(xyz(load4(positions, i)), xyz(load4(goals, i))));
    // NaN is no way to stay.
    const whole stays = way <= splat(WEFT_LOOSE_SHARE) * limit ? splat_whole(1) : splat_whole(0);
    const whole is_slow =
        load4(anchors, i).w < splat(WEFT_DRIFT_SHARE) * limit ? splat_whole(1) : splat_whole(0);
    const whole now = splat_whole(1) - larger_whole(stays, is_slow);
    store_whole(unquiet, i, instance == 0 ? now : larger_whole(now, load_whole(unquiet, i)));
}

WEFT_KERNELS_END

#endif
