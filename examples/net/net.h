#ifndef NET_H
#define NET_H
#include <weft/kernel.h>

WEFT_KERNELS_IN(net)

/// A knot of the net: where it is [m], how fast [m/s], and 1 / its mass [1/kg], 0 for held ones.
typedef struct {
    float x, y, z;
    float vx, vy, vz;
    float inverse_mass;
} Knot;

WEFT_INLINE real3 place_of(WEFT_GLOBAL const Knot* knots, integer k) {
    return make3(gather_member(knots, k, x), gather_member(knots, k, y),
                 gather_member(knots, k, z));
}

/// What a spring pulls with [N]: stiffness * (length - rest), towards the other end. A spring from
/// a knot to itself stands for none.
WEFT_INLINE real3 pull_of(real3 here, real3 there, real stiffness, real rest) {
    const real3 along = subtract(there, here);
    const real length = length3(along);
    const real pull = length > splat(0.0f) ? stiffness * (length - rest) : splat(0.0f);
    return scale(along, pull / divisor(length));
}

/// A step of time h: velocities by the springs and by gravity, and then places by the velocities.
/// now, next   [knots] next is written
/// neighbours  [4 * knots] column-major; a knot that is its own neighbour has none there
WEFT_KERNEL(swing, WEFT_GLOBAL const Knot* now, WEFT_GLOBAL Knot* next,
            WEFT_GLOBAL const int* neighbours, int knots, float stiffness, float rest, float h,
            float gravity) {
    const integer self = address(item_numbers(i));
    const real3 x = place_of(now, self);
    const real inverse_mass = load_member(now, i, inverse_mass);
    real3 force = make3(splat(0.0f), splat(0.0f), splat(0.0f));
    for (int k = 0; k < 4; ++k) {
        const real3 other = place_of(now, load_index(neighbours, column(i, knots, k)));
        force = add(force, pull_of(x, other, splat(stiffness), splat(rest)));
    }
    const real free = inverse_mass > splat(0.0f) ? splat(1.0f) : splat(0.0f);
    const real3 fall = make3(splat(0.0f), free * splat(gravity), splat(0.0f));
    const real3 v =
        make3(load_member(now, i, vx), load_member(now, i, vy), load_member(now, i, vz));
    const real3 faster = add_scaled(v, add(scale(force, inverse_mass), fall), splat(h));
    const real3 moved = add_scaled(x, faster, splat(h));
    store_member(next, i, x, moved.x);
    store_member(next, i, y, moved.y);
    store_member(next, i, z, moved.z);
    store_member(next, i, vx, faster.x);
    store_member(next, i, vy, faster.y);
    store_member(next, i, vz, faster.z);
    store_member(next, i, inverse_mass, inverse_mass);
}

WEFT_KERNELS_END
#endif
