#ifndef WEFT_KERNELS_CONTACT_FRICTION_H
#define WEFT_KERNELS_CONTACT_FRICTION_H

// Coulomb friction, smoothed where it sticks (Li et al. 2020, IPC, section 5): two surfaces that
// press each other by N and have slid by a way u rub by
//
//   mu N f(|u|/e) u/|u|,      f(y) = 2y - y^2 below 1, and 1 beyond
//
// so what sticks gives way by less than e. N and the tangents are those at hand and no variables;
// in these terms the force is the slope of mu N D(|u|), of which kernels need no value. D is
// concave in |u|^2, so that mu N f/|u| |u|^2/2 bounds it from above where they touch: it is the
// curvature that rows.h takes, and an iteration lowers what it is made for.

#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// f / |u| [1/m]: the force per slip, of a normal force and a coefficient of 1.
/// slip   |u| [m]
/// creep  e [m], > 0
WEFT_INLINE real friction_grip(real slip, real creep) {
    const real beyond = splat(1.0f) / larger(slip, creep);
    return slip < creep ? (splat(2.0f) - slip / creep) / creep : beyond;
}

/// D [m]: the integral of f, 0 where there is no slip.
WEFT_INLINE real friction_potential(real slip, real creep) {
    const real third = splat(1.0f) / splat(3.0f);
    const real y = slip / creep;
    return slip < creep ? creep * y * y * (splat(1.0f) - third * y) : slip - third * creep;
}

WEFT_KERNELS_END

#endif
