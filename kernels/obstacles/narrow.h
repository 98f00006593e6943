#ifndef WEFT_KERNELS_OBSTACLES_NARROW_H
#define WEFT_KERNELS_OBSTACLES_NARROW_H

// Obstacles that are narrower than triangles pass between vertices, unless the triangles stop them.
//
// Behind each iteration, and behind the pushes of vertices (contact.h), each vertex looks at the
// triangles around it, and takes its part of what keeps them out: a plane that it is on the wrong
// side of. Another launch then pushes it there, as it pushes a vertex out of the obstacle itself.

#include "kernels/obstacles/core.h"

WEFT_KERNELS_BEGIN

/// [m] of the corner that has moved the most.
WEFT_INLINE real farthest_way(corners3 start, corners3 end) {
    const real3 a = subtract(end.a, start.a);
    const real3 b = subtract(end.b, start.b);
    const real3 c = subtract(end.c, start.c);
    return square_root(larger(dot3(a, a), larger(dot3(b, b), dot3(c, c))));
}

/// [m] from the core to the nearest corner.
WEFT_INLINE real nearest_corner(corners3 t, float4 core) {
    const real3 a = subtract(t.a, nearest_of_core(t.a, core));
    const real3 b = subtract(t.b, nearest_of_core(t.b, core));
    const real3 c = subtract(t.c, nearest_of_core(t.c, core));
    return square_root(smaller(dot3(a, a), smaller(dot3(b, b), dot3(c, c))));
}

/// [m] no point of a triangle is farther from its nearest corner: where all edges are as long as
/// the longest, its middle is.
WEFT_INLINE real most_inside(corners3 t) {
    const real3 ab = subtract(t.b, t.a);
    const real3 bc = subtract(t.c, t.b);
    const real3 ca = subtract(t.a, t.c);
    const real longest = larger(dot3(ab, ab), larger(dot3(bc, bc), dot3(ca, ca)));
    return square_root(longest) * splat(0.578f);
}

/// A corner of less weight has no part in where a triangle meets an obstacle.
#define WEFT_HAS_PART 0.01f

/// Where corners are held, others move for them, but no further than so many times the depth.
#define WEFT_MOST_FOR_OTHERS 4.0f

/// What the corner with `weight` and `inverse_mass` moves, so that the triangle's point moves by
/// all of the depth and momentum is kept among the corners (Mueller et al. 2007, section 3.3).
WEFT_INLINE real share_of_push(core_meeting m, real3 inverse_masses, real weight, real inverse_mass,
                               real depth) {
    const real3 moves = make3(m.weights.x * inverse_masses.x, m.weights.y * inverse_masses.y,
                              m.weights.z * inverse_masses.z);
    const real share = weight * inverse_mass / divisor(dot3(moves, m.weights));
    return depth * smaller(share, splat(WEFT_MOST_FOR_OTHERS));
}

/// A triangle around a vertex, seen from an obstacle.
typedef struct {
    real counts;  ///< 1: it may come as near as is asked for; else there is no more to know
    core_meeting met;
    real3 inverse_masses;  ///< of its corners [1/kg]
    real weight;           ///< of the vertex where it is met
    corners3 world;        ///< where it is [m]
} seen_triangle;

/// core    of the obstacle o
/// k       which of those around the vertex
/// is_on   where the vertex asks for it
/// keep    from the core [m]
/// beyond  [m] what is farther away by more than that does not count
WEFT_INLINE seen_triangle see_triangle(WEFT_GLOBAL const float4* positions,
                                       WEFT_GLOBAL const float4* previous,
                                       WEFT_GLOBAL const int* corners, WEFT_GLOBAL const float4* o,
                                       float4 core, int vertex_count, int k, mask is_on, real keep,
                                       real beyond, item i) {
    const real zero = splat(0.0f);
    const whole none = splat_whole(0);
    const whole one = load_whole(corners, column(i, vertex_count, 3 * k));
    const whole two = load_whole(corners, column(i, vertex_count, 3 * k + 1));
    const whole three = load_whole(corners, column(i, vertex_count, 3 * k + 2));
    const integer at_a = address(larger_whole(one, none));
    const integer at_b = address(larger_whole(two, none));
    const integer at_c = address(larger_whole(three, none));
    const real4 x_a = gather4(positions, at_a);
    const real4 x_b = gather4(positions, at_b);
    const real4 x_c = gather4(positions, at_c);
    seen_triangle seen;
    seen.world.a = xyz(x_a);
    seen.world.b = xyz(x_b);
    seen.world.c = xyz(x_c);
    const corners3 end = {apply(o, seen.world.a), apply(o, seen.world.b), apply(o, seen.world.c)};
    const corners3 start = {local_at_start(o, xyz(gather4(previous, at_a))),
                            local_at_start(o, xyz(gather4(previous, at_b))),
                            local_at_start(o, xyz(gather4(previous, at_c)))};
    const real way = farthest_way(start, end);
    const mask is_there = both(is_on, one >= none);
    const mask may_meet =
        both(is_there, nearest_corner(end, core) < keep + beyond + way + most_inside(end));
    seen.counts = may_meet ? splat(1.0f) : zero;
    seen.met.weights = seen.met.at = seen.met.normal = make3(zero, zero, zero);
    seen.met.distance = seen.weight = zero;
    seen.inverse_masses = make3(x_a.w, x_b.w, x_c.w);
    if (!any_item(may_meet)) return seen;
    const mask is_swept = both(may_meet, way * way >= splat(o[7].z));
    seen.met = meet_core(end, core);
    if (any_item(is_swept)) {
        const core_meeting met = meet_core_on_way(start, end, seen.met, core, keep);
        seen.met = choose_meeting(is_swept, met, seen.met);
    }
    const whole self = item_numbers(i);
    const real3 weights = seen.met.weights;
    seen.weight = self == one ? weights.x : self == two ? weights.y : weights.z;
    return seen;
}

/// Whether triangles around a vertex may come to an obstacle.
/// near  [m] a vertex farther from the core has no triangle that does
WEFT_INLINE mask may_have_met(WEFT_GLOBAL const float4* o, float4 core, real4 x, real3 before,
                              real near) {
    const real3 start = local_at_start(o, before);
    const real3 end = apply(o, xyz(x));
    const real away = length3(subtract(end, nearest_of_core(end, core)));
    return both(x.w > splat(0.0f), away < near + length3(subtract(end, start)));
}

/// What triangles ask of a vertex that keep out of one obstacle. Of several the one that asks for
/// the most counts.
/// positions   [vertices] xyz [m], w = 1/mass [1/kg]
/// previous    [vertices] xyz at the substep's start [m]
/// corners     [3 * slots * vertex_count] column-major: of the triangles around each vertex; -1
///             behind the last of them
/// obstacles   [substeps * obstacle_count * WEFT_OBSTACLE_ROWS], see contact.h
/// planes      [narrow obstacles * vertex_count] column-major, written: xyz: the normal, w: where
///             it is along it [m]; a normal of 0: none
/// depths      [narrow obstacles * vertex_count] column-major, written where `notes` is not 0: how
///             deep in the obstacle triangles were near the vertex, the most in the frame so far [m]
/// slots       the most triangles at a vertex
/// reach       [m] a vertex farther away has no triangle that meets it
/// obstacle    which one, and `narrow` among those that have planes
WEFT_NARROW_KERNEL(find_obstacle_planes, WEFT_GLOBAL const float4* positions,
                   WEFT_GLOBAL const float4* previous, WEFT_GLOBAL const int* corners,
                   WEFT_GLOBAL const float4* obstacles, WEFT_GLOBAL float4* planes,
                   WEFT_GLOBAL float* depths, int notes, int vertex_count, int slots, float reach,
                   int obstacle_count, int obstacle, int narrow, int substep) {
    WEFT_GLOBAL const float4* o =
        obstacles + WEFT_OBSTACLE_ROWS * (substep * obstacle_count + obstacle);
    const real zero = splat(0.0f);
    const float4 core = core_of(o);
    const real keep = splat(core.w + o[7].x);
    const real4 x = load4(positions, i);
    real3 normal = make3(zero, zero, zero);
    real most = zero;
    real deepest = zero;
    const mask is_near = may_have_met(o, core, x, xyz(load4(previous, i)), keep + splat(reach));
    if (any_item(is_near)) {
        for (int k = 0; k < slots; ++k) {
            if (largest_whole(load_whole(corners, column(i, vertex_count, 3 * k))) < 0) break;
            const seen_triangle seen = see_triangle(positions, previous, corners, o, core,
                                                    vertex_count, k, is_near, keep, zero, i);
            const mask may_meet = seen.counts > zero;
            if (!any_item(may_meet)) continue;
            const real depth = keep - seen.met.distance;
            const real push = share_of_push(seen.met, seen.inverse_masses, seen.weight, x.w, depth);
            const mask counts = both(may_meet, push > most);
            most = counts ? push : most;
            normal = either(counts, seen.met.normal, normal);
            const mask is_here = both(may_meet, seen.weight > splat(WEFT_HAS_PART));
            deepest = both(is_here, depth > deepest) ? depth : deepest;
        }
    }
    const real3 out = apply_back(o, normal);
    const real there = dot3(out, xyz(x)) + most;
    const real nowhere = splat(-3e38f);
    store4(planes, column(i, vertex_count, narrow), with_w(out, most > zero ? there : nowhere));
    if (notes == 0) return;
    const real before = substep == 0 ? zero : load(depths, column(i, vertex_count, narrow));
    store(depths, column(i, vertex_count, narrow), larger(deepest, before));
}

/// How near to an obstacle there is no meeting.
#define WEFT_NO_MEETING 3e38f

/// The triangle around each vertex that is nearest to one obstacle, where the vertex has a part in
/// what it meets: to bodies as wholes that lie on narrow obstacles, it is there that these press
/// (contact/resting.h).
/// meetings  [2 * obstacle_count * vertex_count] column-major, written: xyz: the normal, w: the gap
///           [m], WEFT_NO_MEETING where there is no triangle nearer than `beyond`; xyz: the point
///           of the triangle [m]
/// beyond    [m]
/// others as in find_obstacle_planes
WEFT_NARROW_KERNEL(find_obstacle_meetings, WEFT_GLOBAL const float4* positions,
                   WEFT_GLOBAL const float4* previous, WEFT_GLOBAL const int* corners,
                   WEFT_GLOBAL const float4* obstacles, WEFT_GLOBAL float4* meetings,
                   int vertex_count, int slots, float reach, float beyond, int obstacle_count,
                   int obstacle, int substep) {
    WEFT_GLOBAL const float4* o =
        obstacles + WEFT_OBSTACLE_ROWS * (substep * obstacle_count + obstacle);
    const real zero = splat(0.0f);
    const float4 core = core_of(o);
    const real keep = splat(core.w + o[7].x);
    const real4 x = load4(positions, i);
    real3 normal = make3(zero, zero, zero);
    real3 point = normal;
    real least = splat(WEFT_NO_MEETING);
    const mask is_near = may_have_met(o, core, x, xyz(load4(previous, i)), keep + splat(reach));
    if (any_item(is_near)) {
        for (int k = 0; k < slots; ++k) {
            if (largest_whole(load_whole(corners, column(i, vertex_count, 3 * k))) < 0) break;
            const seen_triangle seen =
                see_triangle(positions, previous, corners, o, core, vertex_count, k, is_near, keep,
                             splat(beyond), i);
            const real gap = seen.met.distance - keep;
            const mask has_part = both(seen.counts > zero, seen.weight > splat(WEFT_HAS_PART));
            const mask is_nearest = both(has_part, gap < least);
            least = is_nearest ? gap : least;
            normal = either(is_nearest, seen.met.normal, normal);
            point = either(is_nearest, weighted3(seen.world, seen.met.weights), point);
        }
    }
    store4(meetings, column(i, vertex_count, 2 * obstacle), with_w(apply_back(o, normal), least));
    store4(meetings, column(i, vertex_count, 2 * obstacle + 1), with_w(point, zero));
}

WEFT_KERNELS_END

#endif
