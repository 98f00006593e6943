#ifndef WEFT_KERNELS_BODIES_REACTIONS_H
#define WEFT_KERNELS_BODIES_REACTIONS_H

// What obstacles bear of a body. Each push leads x~ along, by what the vertex alone weighs
// (obstacles/contact.h): a stiff body that is pressed on an obstacle, or what others press on it,
// would take many more pushes than there are iterations until these add up to what bears it. The
// body would seem to lack momentum, and be led into what bears it, by its own step. So behind the
// last iteration x~ of what has been pushed is led on to where nothing presses the vertex into the
// obstacle any more. Not of what the planes of triangles have pushed (obstacles/narrow.h): these
// press between vertices, and what stiff elements pass on to each of them differs by far more than
// all that bears the body. Rounds know the place (contact/resting.h).

#include "kernels/descent/vertex_system.h"
#include "kernels/lanes.h"
#include "kernels/obstacles/grip.h"

WEFT_KERNELS_BEGIN

/// positions   [vertices] xyz [m], w = 1/mass [1/kg]
/// starts      [vertices] xyz: x~ before all pushes [m]
/// targets     [vertices] xyz: x~ [m], w: the grip (obstacles/grip.h) [m]; written
/// borne       [vertices] 1: of a body for which this counts; else 0
/// vertices    [items] the vertex of each item
/// sums        [9 * items] gradients of all elements and contacts; see descent/rows.h
/// pressing    [vertices] see obstacles/contact.h: what obstacles bear across their surfaces is all
///             that is asked for
/// inverse_h2  1 / h^2 [1/s^2], h the substep
WEFT_KERNEL(lead_by_reactions, WEFT_GLOBAL const float4* positions,
            WEFT_GLOBAL const float4* starts, WEFT_GLOBAL float4* targets,
            WEFT_GLOBAL const float* borne, WEFT_GLOBAL const int* vertices,
            WEFT_GLOBAL const float* sums, WEFT_GLOBAL const float4* pressing, int item_count,
            float inverse_h2) {
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const integer vertex = load_index(vertices, i);
    const real4 target = gather4(targets, vertex);
    const real4 x = gather4(positions, vertex);
    const real4 pressed = gather4(pressing, vertex);
    const mask was_pushed =
        both(both(target.w * gather(borne, vertex) > zero, x.w > zero), pressed.w == zero);
    if (!any_item(was_pushed)) return;
    const real3 all = subtract(xyz(target), xyz(gather4(starts, vertex)));
    const real3 push = pushed_along(all, xyz(pressed));
    const real length = length3(push);
    // A few roundings of a coordinate have no direction.
    const mask is_pushed = both(was_pushed, length > splat(2.5e-7f) * length3(xyz(x)));
    const real3 up = scale(push, one / divisor(length));
    // The inertia that goes with a way of one metre, per force of one newton.
    const real yielding = (is_pushed ? x.w : one) / splat(inverse_h2);
    const real3 lag = subtract(xyz(target), xyz(x));
    const real3 lack = add_scaled(lag, load_gradient(sums, i, item_count), -yielding);
    const real more = is_pushed ? larger(-dot3(lack, up), zero) : zero;
    const real grip = target.w * ((length + more) / divisor(length));
    // What sticks is held aside, too; what slides is rubbed by as much as it has been.
    const mask sticks =
        both(more > zero, target.w > larger(length * splat(1e-3f), splat(WEFT_NO_GRIP)));
    const real3 along = scale(up, more);
    const real3 led =
        make3(sticks ? -lack.x : along.x, sticks ? -lack.y : along.y, sticks ? -lack.z : along.z);
    scatter4_where(is_pushed, targets, vertex,
                   with_w(add(xyz(target), led), larger(grip, target.w)));
}

WEFT_KERNELS_END

#endif
