#ifndef WEFT_KERNELS_CONTACT_ENERGY_H
#define WEFT_KERNELS_CONTACT_ENERGY_H

// The energy of two surfaces that are near each other, as a function of the gap g between them. It
// begins at a range r and pushes from there inwards, softly at first and then harder, so that a
// load is borne before the surfaces meet; with tau = r/2 and k the stiffness,
//
//   E = k/2 (r - g)^2                              tau <= g < r
//   E = k tau^2/2 (1 + tau/g - g/tau)              g < tau
//
// E, E' and E'' agree at tau. The second stage has no logarithm (as that of Chen et al. 2025,
// Offset Geometric Contact, has: k tau^2 (1/2 - ln(g/tau))): devices would not round it alike, and
// where it pushes equally hard it is less stiff. Below r/16 E goes on as a parabola: surfaces that
// overlap for a moment have an energy, too.

#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// The largest tau / g in the second stage, and the largest that is looked ahead to.
#define WEFT_STEEPEST 8.0f
#define WEFT_STEEPEST_AHEAD 4.0f

/// tau / g where the second stage holds; 1 in the first one.
WEFT_INLINE real contact_steepness(real gap, real range) {
    const real tau = splat(0.5f) * range;
    const real least = tau * splat(1.0f / WEFT_STEEPEST);
    return tau / smaller(larger(gap, least), tau);
}

/// E [J]
WEFT_INLINE real contact_energy(real gap, real range, real stiffness) {
    const real one = splat(1.0f);
    const real by2 = splat(0.5f);
    const real tau = by2 * range;
    const real missing = larger(range - gap, splat(0.0f));
    const real soft = by2 * stiffness * missing * missing;
    const real q = contact_steepness(gap, range);
    const real beyond = smaller(gap - tau * splat(1.0f / WEFT_STEEPEST), splat(0.0f));
    const real slope = -by2 * stiffness * tau * (q * q + one);
    const real stage = by2 * stiffness * tau * tau * (one + q - one / q);
    const real hard = stage + (slope + by2 * stiffness * q * q * q * beyond) * beyond;
    return gap < tau ? hard : soft;
}

/// dE/dg [N], never positive
WEFT_INLINE real contact_slope(real gap, real range, real stiffness) {
    const real tau = splat(0.5f) * range;
    const real q = contact_steepness(gap, range);
    const real beyond = smaller(gap - tau * splat(1.0f / WEFT_STEEPEST), splat(0.0f));
    const real soft = -stiffness * larger(range - gap, splat(0.0f));
    const real hard = stiffness * (q * q * q * beyond - splat(0.5f) * tau * (q * q + splat(1.0f)));
    return gap < tau ? hard : soft;
}

/// d2E/dg2 [N/m] where there is any energy, and k where there is none.
WEFT_INLINE real contact_curvature(real gap, real range, real stiffness) {
    const real q = contact_steepness(gap, range);
    return stiffness * q * q * q;
}

/// What takes the place of the curvature in a step that begins at a gap, while the bodies' inertia
/// is on its way to another one: that at the gap at hand, or where the energy bears what drives the
/// bodies that far, if this is about k (range - ahead).
WEFT_INLINE real contact_majorant(real gap, real ahead, real range, real stiffness) {
    const real drive = splat(4.0f) * (range - ahead) / range - splat(1.0f);
    const real most = splat(WEFT_STEEPEST_AHEAD);
    const real q = square_root(smaller(larger(drive, splat(1.0f)), most * most));
    return larger(contact_curvature(gap, range, stiffness), stiffness * q * q * q);
}

WEFT_KERNELS_END

#endif
