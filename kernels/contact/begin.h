#ifndef WEFT_KERNELS_CONTACT_BEGIN_H
#define WEFT_KERNELS_CONTACT_BEGIN_H

#include "kernels/lanes.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// What contacts are looked for with: where each vertex is, and how far it may get. What a group of
/// bodies does together is no matter of contact: anchors move with it, and what comes behind is all
/// relative to them. Planes between two sides that move by one translation move with it, and what
/// is on its side of one before and behind, was so on its straight way.
/// positions  [vertices] xyz: of held vertices where they will be [m], w = 1/mass [1/kg]
/// previous   [vertices] xyz: x_t
/// targets    [vertices] xyz: x~ of free vertices
/// goals      [vertices] written: xyz: where inertia, or the scene, leads; w = 1/mass
/// anchors    [vertices] from those of the substep before to those of this one: xyz: x_t + u, w: the
///            radius of the ball in which it stays [m]
/// strides    [vertices] written: what has changed of them
/// bodies     [vertices] whose each is
/// carried    [substeps * body_count] xyz: u, what the body's group does together in the substep,
///            w: the farthest that the scene leads one of the group, and that obstacles may push
///            it back: so far others may be pushed [m]
/// margin     by which a vertex may go farther than that and its inertia [m]
/// most       that it may go [m]
WEFT_KERNEL(begin_contacts, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float4* previous,
            WEFT_GLOBAL const float4* targets, WEFT_GLOBAL float4* goals,
            WEFT_GLOBAL float4* anchors, WEFT_GLOBAL float4* strides, WEFT_GLOBAL const int* bodies,
            WEFT_GLOBAL const float4* carried, int body_count, float margin, float most,
            int substep) {
    const real4 x = load4(positions, i);
    const real4 together = gather4(carried + substep * body_count, load_index(bodies, i));
    const real3 anchor = add(xyz(load4(previous, i)), xyz(together));
    const real4 target = load4(targets, i);
    const mask moves = x.w > splat(0.0f);
    const real3 goal =
        make3(moves ? target.x : x.x, moves ? target.y : x.y, moves ? target.z : x.z);
    const real way = length3(subtract(goal, anchor));
    const real pushed = moves ? together.w : splat(0.0f);
    store4(goals, i, with_w(goal, x.w));
    const real reach = smaller(way, splat(most)) + splat(margin) + pushed;
    const real4 before = load4(anchors, i);
    store4(strides, i, with_w(subtract(anchor, xyz(before)), reach - before.w));
    store4(anchors, i, with_w(anchor, reach));
}

/// In how many substeps of the frame contacts took each vertex back, and in how many it could not
/// be put where all of them allow it to be.
/// cut      [vertices] 1 where they took it back in this one, 2 where there was no such place
/// anchors  [vertices] xyz: where contacts were looked for [m]
/// goals    [vertices] xyz: where inertia led from there [m]
/// counts   [2 * vertices] written: of both
/// ways     [vertices] written: the longest way that inertia led one that was taken back [m]
WEFT_KERNEL(count_cut, WEFT_GLOBAL const int* cut, WEFT_GLOBAL const float4* anchors,
            WEFT_GLOBAL const float4* goals, WEFT_GLOBAL int* counts, WEFT_GLOBAL float* ways,
            int vertex_count, int instance) {
    const whole none = splat_whole(0);
    const whole one = splat_whole(1);
    const whole now = load_whole(cut, i);
    if (instance != 0 && largest_whole(now) == 0) return;
    const item second = column(i, vertex_count, 1);
    const whole before = instance == 0 ? none : load_whole(counts, i);
    const whole lost_before = instance == 0 ? none : load_whole(counts, second);
    store_whole(counts, i, before + (now > none ? one : none));
    store_whole(counts, second, lost_before + (now > one ? one : none));
    const real zero = splat(0.0f);
    const real way = length3(subtract(xyz(load4(goals, i)), xyz(load4(anchors, i))));
    const real longest = instance == 0 ? zero : load(ways, i);
    store(ways, i, larger(longest, now > none ? way : zero));
}

WEFT_KERNELS_END

#endif
