#ifndef WEFT_KERNELS_XPBD_CURVED_HINGES_H
#define WEFT_KERNELS_XPBD_CURVED_HINGES_H

#include "kernels/curved_hinge_weights.h"
#include "kernels/energies/curved_hinge.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// A corner of a hinge, and what its constraint's gradient is there.
typedef struct {
    real4 x;
    real q;
    real3 spin;
} curved_corner;

/// |dC/dx|^2 of the corner over its mass, for C = |b| and b's direction
WEFT_INLINE real curved_mobility(curved_corner c, real3 direction) {
    const real3 gradient = curved_hinge_gradient(direction, c.q, c.spin);
    return c.x.w * dot3(gradient, gradient);
}

WEFT_INLINE real4 pushed_corner(curved_corner c, real3 push) {
    const real3 gradient = curved_hinge_gradient(push, c.q, c.spin);
    return with_w(add_scaled(xyz(c.x), gradient, c.x.w), c.x.w);
}

/// Projects hinges that are folded at rest (energies/curved_hinge.h) as XPBD constraints C = |b|
/// with compliance 1; the stiffness is part of the weights.
/// positions    [vertices] xyz [m], w = 1/mass [1/kg]; read and written
/// corners      [4 * hinge_count] column-major: the edge's two vertices, the two opposite
/// weights      [6 * hinge_count] column-major, as seen from corner 0; the pair of 2 and 3 has none
/// multipliers  [hinge_count] lambda; taken as 0 where `fresh`
/// inverse_h2   1 / h^2 [1/s^2], h the substep
/// fresh        1 in the first iteration of a substep, else 0
/// Hinges of one call share no vertex.
WEFT_KERNEL(project_curved_hinges, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* weights, WEFT_GLOBAL float* multipliers, int hinge_count,
            float inverse_h2, int fresh) {
    const integer k0 = load_index(corners, i);
    const integer k1 = load_index(corners, column(i, hinge_count, 1));
    const integer k2 = load_index(corners, column(i, hinge_count, 2));
    const integer k3 = load_index(corners, column(i, hinge_count, 3));
    const curved_hinge h = load_curved_hinge(weights, i, hinge_count);
    const real multiplier = fresh ? splat(0.0f) : load(multipliers, i);
    const real4 x0 = gather4(positions, k0);
    const real4 x1 = gather4(positions, k1);
    const real4 x2 = gather4(positions, k2);
    const real4 x3 = gather4(positions, k3);

    const real3 y1 = subtract(xyz(x1), xyz(x0));
    const real3 y2 = subtract(xyz(x2), xyz(x0));
    const real3 y3 = subtract(xyz(x3), xyz(x0));
    const real3 bend = curved_hinge_bend(h, y1, y2, y3);
    const curved_corner c0 = {x0, curved_hinge_weight(h), curved_hinge_spin(h, y1, y2, y3)};
    const curved_corner c1 = {x1, h.q1, add_scaled(scale(y2, -h.p12), y3, -h.p13)};
    const curved_corner c2 = {x2, h.q2, scale(y1, h.p12)};
    const curved_corner c3 = {x3, h.q3, scale(y1, h.p13)};
    const real error = length3(bend);
    const real3 direction = scale(bend, splat(1.0f) / divisor(error));
    const real mobility = (curved_mobility(c0, direction) + curved_mobility(c1, direction)) +
                          (curved_mobility(c2, direction) + curved_mobility(c3, direction));
    const real change = (-error - inverse_h2 * multiplier) / (mobility + inverse_h2);
    const real3 push = scale(direction, change);

    store(multipliers, i, multiplier + change);
    scatter4(positions, k0, pushed_corner(c0, push));
    scatter4(positions, k1, pushed_corner(c1, push));
    scatter4(positions, k2, pushed_corner(c2, push));
    scatter4(positions, k3, pushed_corner(c3, push));
}

WEFT_KERNELS_END

#endif
