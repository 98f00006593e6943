#ifndef WEFT_KERNELS_OBSTACLES_CONTACT_H
#define WEFT_KERNELS_OBSTACLES_CONTACT_H

// What all obstacle shapes share. A shape is convex and supplies one function, near_<shape>: the
// signed distance of a point and the normal there, in its own frame; WEFT_OBSTACLE_KERNELS makes
// its kernel of it.
//
// A vertex that has gone far since its substep began may be past the obstacle, or nearer to its
// other side. Then it is swept: its way counts, taken as straight in the obstacle's frame, and the
// plane through its first contact is what pushes it out. The vertex and where it came from end up
// on one side of a plane that has the whole obstacle on its other side.
//
// Each push asks that of each vertex, as nothing that is known before a substep says how far its
// iterations take one: a stiff edge that snaps is gone and stopped again within a frame.

#include "kernels/lanes.h"
#include "kernels/obstacles/grip.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// Where a point is, seen from a surface.
typedef struct {
    real distance;  ///< [m], negative inside
    real3 normal;   ///< of length 1, outwards
} nearness;

/// float4 per obstacle and substep:
///   0..2  rows (r, t) of the map from the world at the substep's end to the local frame
///   3..5  rows of the map from the local frame to the world at the substep's start
///   6     dimensions [m], as the shape reads them
///   7     thickness [m], friction coefficient, square of the way from which on a vertex is swept
///         [m^2] (the largest number: none is), its shape's number (shapes.h)
#define WEFT_OBSTACLE_ROWS 8

/// The distance is convex along a straight way, so Newton's method comes to the first contact from
/// before it, and doubles its digits in each step; only of ways that graze the surface it leaves
/// 1/2 of the gap, and there the gap is nothing. Wherever it stops, the plane there separates.
#define WEFT_SWEEP_STEPS 8

/// rows . (p, 1)
WEFT_INLINE real3 apply(WEFT_GLOBAL const float4* rows, real3 p) {
    return make3(p.x * rows[0].x + p.y * rows[0].y + p.z * rows[0].z + splat(rows[0].w),
                 p.x * rows[1].x + p.y * rows[1].y + p.z * rows[1].z + splat(rows[1].w),
                 p.x * rows[2].x + p.y * rows[2].y + p.z * rows[2].z + splat(rows[2].w));
}

/// The transposed rotation of `rows`: a direction back into the world.
WEFT_INLINE real3 apply_back(WEFT_GLOBAL const float4* rows, real3 d) {
    return make3(d.x * rows[0].x + d.y * rows[1].x + d.z * rows[2].x,
                 d.x * rows[0].y + d.y * rows[1].y + d.z * rows[2].y,
                 d.x * rows[0].z + d.y * rows[1].z + d.z * rows[2].z);
}

/// The local frame's point that was at `p` at the substep's start.
WEFT_INLINE real3 local_at_start(WEFT_GLOBAL const float4* obstacle, real3 p) {
    WEFT_GLOBAL const float4* rows = obstacle + 3;
    const real3 origin = make3(splat(rows[0].w), splat(rows[1].w), splat(rows[2].w));
    return apply_back(rows, subtract(p, origin));
}

/// The part of a way after which the thickness may be reached, from where it is not yet: `part`
/// itself if it is reached there, 1 if it never is.
/// near  what the way meets at `part`
WEFT_INLINE real advance_to_contact(nearness near, real3 way, real part, float thickness) {
    const real one = splat(1.0f);
    const real gap = near.distance - splat(thickness);
    const real growth = dot3(near.normal, way);
    const real next = growth < splat(0.0f) ? smaller(part - gap / growth, one) : one;
    return gap > splat(0.0f) ? next : part;
}

/// How far a vertex has to be pushed: to the thickness, and never a held one.
WEFT_INLINE real push_depth(WEFT_GLOBAL const float4* obstacle, real distance, real inverse_mass) {
    const real depth = splat(obstacle[7].x) - distance;
    const real touching = depth > splat(0.0f) ? depth : splat(0.0f);
    return inverse_mass > splat(0.0f) ? touching : splat(0.0f);
}

/// How far friction may take a vertex back.
WEFT_INLINE real most_grip(WEFT_GLOBAL const float4* obstacle, real distance, real grip,
                           real inverse_mass) {
    const real most = grip + (splat(obstacle[7].x) - distance) * splat(obstacle[7].y);
    return inverse_mass > splat(0.0f) ? larger(most, splat(0.0f)) : splat(0.0f);
}

/// What a vertex has slid along the surface since the substep began. The obstacle's own motion
/// counts: the point of the obstacle where the vertex is now, was at S . (W . x) before.
WEFT_INLINE real3 slid_along(WEFT_GLOBAL const float4* obstacle, real3 pushed, real3 previous,
                             real3 normal) {
    const real3 carried = apply(obstacle + 3, apply(obstacle, pushed));
    const real3 way = subtract(carried, previous);
    return along_surface(way, normal);
}

/// The part of it that friction takes back, which reaches so far [m] at the most.
WEFT_INLINE real part_held(real3 slid, real most) {
    return smaller(most / divisor(length3(slid)), splat(1.0f));
}

/// Who is told of a push by obstacles besides the vertex.
#define WEFT_PUSH_ALONE 0    ///< nobody: xpbd where no body is moved as a whole
#define WEFT_PUSH_LEADS 1    ///< x~, which is led along, and the grip
#define WEFT_PUSH_PRESSES 2  ///< these, and what presses, as which solids see it
#define WEFT_PUSH_LAST 3     ///< behind the step of bodies as wholes: the grip

typedef struct {
    real3 place;  ///< of the vertex [m]
    real4 target;
    real3 pressing;  ///< the normal times how far it has been pushed [m]
} pushed_vertex;

/// Moves a vertex out of an obstacle, with Coulomb's friction on positions (Macklin et al. 2014,
/// section 6.1). It takes back what the vertex has slid, by friction * depth at the most, of all
/// pushes of the substep up to this one. What those before have left of that is the vertex' grip.
/// Behind the last of them, when its body has moved as a whole, that holds what is pushed no more,
/// too; less friction * way where it has been lifted off.
///
/// x~ is led along: the inertia that pulls a vertex towards it would pull it into the obstacle
/// again in every iteration, and be rubbed every time.
/// near      of x, the normal in the world
/// previous  the vertex at the substep's start [m]
/// target    xyz: x~ [m], w: the grip [m]
WEFT_INLINE pushed_vertex push_vertex(WEFT_GLOBAL const float4* obstacle, nearness near, real4 x,
                                      real3 previous, real4 target, int told) {
    const real zero = splat(0.0f);
    const real depth = push_depth(obstacle, near.distance, x.w);
    pushed_vertex v;
    v.place = add_scaled(xyz(x), near.normal, depth);
    real used = zero;
    if (obstacle[7].y > 0.0f) {
        const real most = most_grip(obstacle, near.distance, target.w, x.w);
        const real held = told == WEFT_PUSH_LAST ? most : depth;
        const real3 slid = slid_along(obstacle, v.place, previous, near.normal);
        const real part = held > zero ? part_held(slid, most) : zero;
        v.place.x = held > zero ? v.place.x - slid.x * part : v.place.x;
        v.place.y = held > zero ? v.place.y - slid.y * part : v.place.y;
        v.place.z = held > zero ? v.place.z - slid.z * part : v.place.z;
        used = part * length3(slid);
    }
    const real3 way = subtract(v.place, xyz(x));
    const real3 lead = told == WEFT_PUSH_LAST ? scale(way, zero) : way;
    const real left = grip_left(target.w, depth * splat(obstacle[7].y), used);
    v.target = with_w(add(xyz(target), lead), grip_of_pushed(left, depth));
    v.pressing = scale(near.normal, depth);
    return v;
}

/// Seen from the obstacle itself, or from the plane that triangles have given the vertex, whichever
/// asks for more (narrow.h). The normals are the world's.
/// plane  xyz: its normal, w: where it is along that [m]
WEFT_INLINE nearness or_from_plane(nearness near, real3 x, real4 plane, float thickness) {
    const real distance = dot3(xyz(plane), x) - plane.w + splat(thickness);
    near.normal.x = distance < near.distance ? plane.x : near.normal.x;
    near.normal.y = distance < near.distance ? plane.y : near.normal.y;
    near.normal.z = distance < near.distance ? plane.z : near.normal.z;
    near.distance = smaller(near.distance, distance);
    return near;
}

/// push_out_of_<shape> moves vertices out of one obstacle.
/// positions   [vertices] xyz [m], w = 1/mass [1/kg]; read and written
/// previous    [vertices] xyz at the substep's start [m]
/// targets     [vertices] xyz: x~ [m], w: the grip [m]; read and written unless WEFT_PUSH_ALONE
/// pressing    [vertices] xyz: of all pushes of the substep [m], w: 1 where planes pushed, else 0;
///             read and written with WEFT_PUSH_PRESSES
/// obstacles   [substeps * obstacle_count * WEFT_OBSTACLE_ROWS], see above
/// planes      [narrow obstacles * vertex_count] column-major, see narrow.h
/// told        WEFT_PUSH_...
/// narrow      its number among obstacles that have planes; -1: it has none
/// obstacle    which one
#define WEFT_OBSTACLE_KERNELS(shape)                                                            \
    /* Seen from the plane of the first contact on the way from `start` to `end`. */            \
    WEFT_INLINE nearness met_##shape(WEFT_GLOBAL const float4* o, real3 start, real3 end) {     \
        const real3 way = subtract(end, start);                                                 \
        real part = splat(0.0f);                                                                \
        nearness near = near_##shape(start, o[6]);                                              \
        for (int k = 0; k < WEFT_SWEEP_STEPS; ++k) {                                            \
            part = advance_to_contact(near, way, part, o[7].x);                                 \
            near = near_##shape(add_scaled(start, way, part), o[6]);                            \
        }                                                                                       \
        near.distance = near.distance + (splat(1.0f) - part) * dot3(near.normal, way);          \
        return near;                                                                            \
    }                                                                                           \
                                                                                                \
    /* Of a vertex at x that was at `start`, both in the world; the normal is the frame's. */   \
    WEFT_INLINE nearness seen_from_##shape(WEFT_GLOBAL const float4* o, real3 start, real3 x) { \
        const real3 end = apply(o, x);                                                          \
        const real3 way = subtract(x, start);                                                   \
        const real too_far = dot3(way, way) - splat(o[7].z);                                    \
        const real zero = splat(0.0f);                                                          \
        nearness near = near_##shape(end, o[6]);                                                \
        if (!any_item(too_far >= zero)) return near;                                            \
        /* What is farther from the thickness than it has gone has met nothing on its way. */   \
        const real3 begin = local_at_start(o, start);                                           \
        const real reach = length3(subtract(end, begin)) + splat(o[7].x) - near.distance;       \
        const real swept = too_far >= zero ? reach : splat(-1.0f);                              \
        if (any_item(swept >= zero)) {                                                          \
            const nearness met = met_##shape(o, begin, end);                                    \
            near.distance = swept >= zero ? met.distance : near.distance;                       \
            near.normal.x = swept >= zero ? met.normal.x : near.normal.x;                       \
            near.normal.y = swept >= zero ? met.normal.y : near.normal.y;                       \
            near.normal.z = swept >= zero ? met.normal.z : near.normal.z;                       \
        }                                                                                       \
        return near;                                                                            \
    }                                                                                           \
                                                                                                \
    WEFT_KERNEL(push_out_of_##shape, WEFT_GLOBAL float4* positions,                             \
                WEFT_GLOBAL const float4* previous, WEFT_GLOBAL float4* targets,                \
                WEFT_GLOBAL float4* pressing, WEFT_GLOBAL const float4* obstacles,              \
                WEFT_GLOBAL const float4* planes, int told, int vertex_count, int narrow,       \
                int obstacle_count, int obstacle, int substep) {                                \
        WEFT_GLOBAL const float4* o =                                                           \
            obstacles + WEFT_OBSTACLE_ROWS * (substep * obstacle_count + obstacle);             \
        const real4 x = load4(positions, i);                                                    \
        const real3 start = xyz(load4(previous, i));                                            \
        nearness near = seen_from_##shape(o, start, xyz(x));                                    \
        near.normal = apply_back(o, near.normal);                                               \
        real by_plane = splat(0.0f);                                                            \
        if (narrow >= 0) {                                                                      \
            const real own = near.distance;                                                     \
            const real4 plane = load4(planes, column(i, vertex_count, narrow));                 \
            near = or_from_plane(near, xyz(x), plane, o[7].x);                                  \
            by_plane = near.distance < own ? splat(1.0f) : by_plane;                            \
        }                                                                                       \
        const real depth = push_depth(o, near.distance, x.w);                                   \
        if (told == WEFT_PUSH_LAST || any_item(depth > splat(0.0f))) {                          \
            real4 target = with_w(start, splat(0.0f));                                          \
            if (told != WEFT_PUSH_ALONE) target = load4(targets, i);                            \
            const pushed_vertex v = push_vertex(o, near, x, start, target, told);               \
            store4(positions, i, with_w(v.place, x.w));                                         \
            if (told != WEFT_PUSH_ALONE) store4(targets, i, v.target);                          \
            if (told == WEFT_PUSH_PRESSES) {                                                    \
                const real4 before = load4(pressing, i);                                        \
                const real met = depth > splat(0.0f) ? larger(before.w, by_plane) : before.w;   \
                store4(pressing, i, with_w(add(xyz(before), v.pressing), met));                 \
            }                                                                                   \
        }                                                                                       \
    }

WEFT_KERNELS_END

#endif
