#ifndef WEFT_KERNELS_OBSTACLES_CORE_H
#define WEFT_KERNELS_OBSTACLES_CORE_H

// An obstacle seen from triangles, whose vertices may all be far from it: a core and the radius
// around it. Spheres and capsules are exactly that. Of a box the edges and corners are rounded off,
// by as much as it is wide at its narrowest: where cloth lies around them, its triangles cut them
// off anyway, and its vertices know the box itself.

#include "kernels/choice.h"
#include "kernels/contact/closest.h"
#include "kernels/obstacles/shapes.h"

WEFT_KERNELS_BEGIN

/// xyz: half the widths of the core, a point, segment or rectangle around the local origin; w: the
/// radius [m]
WEFT_INLINE float4 core_of(WEFT_GLOBAL const float4* obstacle) {
    const float4 size = obstacle[6];
    const float shape = obstacle[7].w;
    float4 core = size;
    core.x = core.y = core.z = 0.0f;
    core.w = size.x;
    if (shape == WEFT_OBSTACLE_capsule) core.y = size.y;
    if (shape == WEFT_OBSTACLE_box) {
        const float least = size.y < size.x ? size.y : size.x;
        core.w = size.z < least ? size.z : least;
        core.x = size.x - core.w;
        core.y = size.y - core.w;
        core.z = size.z - core.w;
    }
    return core;
}

/// The point of the core that is nearest to p.
WEFT_INLINE real3 nearest_of_core(real3 p, float4 core) {
    return make3(smaller(larger(p.x, splat(-core.x)), splat(core.x)),
                 smaller(larger(p.y, splat(-core.y)), splat(core.y)),
                 smaller(larger(p.z, splat(-core.z)), splat(core.z)));
}

typedef struct {
    real3 a, b, c;
} corners3;

WEFT_INLINE real3 weighted3(corners3 t, real3 weights) {
    return add_scaled(add_scaled(scale(t.a, weights.x), t.b, weights.y), t.c, weights.z);
}

WEFT_INLINE corners3 advanced3(corners3 t, corners3 ways, real part) {
    t.a = add_scaled(t.a, ways.a, part);
    t.b = add_scaled(t.b, ways.b, part);
    t.c = add_scaled(t.c, ways.c, part);
    return t;
}

/// A point of a triangle, by the weights of its corners, and the way from there to one of the core.
typedef struct {
    real3 weights;
    real3 way;    ///< [m]
    real square;  ///< of its length
} way_to_core;

WEFT_INLINE way_to_core shorter(way_to_core one, way_to_core other) {
    const mask is_shorter = other.square < one.square;
    one.weights = either(is_shorter, other.weights, one.weights);
    one.way = either(is_shorter, other.way, one.way);
    one.square = is_shorter ? other.square : one.square;
    return one;
}

WEFT_INLINE way_to_core from_triangle(corners3 t, real3 point) {
    const closest_points c = closest_vertex_triangle(point, t.a, t.b, t.c);
    const way_to_core found = {{-c.weights.y, -c.weights.z, -c.weights.w}, c.way, c.square};
    return found;
}

WEFT_INLINE way_to_core from_corner(real3 corner, real3 weights, float4 core) {
    const real3 way = subtract(nearest_of_core(corner, core), corner);
    const way_to_core found = {weights, way, dot3(way, way)};
    return found;
}

/// From the edges of a triangle and from all of it to a segment and its ends.
WEFT_INLINE way_to_core from_edges(corners3 t, real3 begin, real3 end) {
    const real zero = splat(0.0f);
    const closest_points ab = closest_edges(begin, end, t.a, t.b);
    const closest_points bc = closest_edges(begin, end, t.b, t.c);
    const closest_points ca = closest_edges(begin, end, t.c, t.a);
    const way_to_core of_ab = {{-ab.weights.z, -ab.weights.w, zero}, ab.way, ab.square};
    const way_to_core of_bc = {{zero, -bc.weights.z, -bc.weights.w}, bc.way, bc.square};
    const way_to_core of_ca = {{-ca.weights.w, zero, -ca.weights.z}, ca.way, ca.square};
    const way_to_core ends = shorter(from_triangle(t, begin), from_triangle(t, end));
    return shorter(shorter(ends, of_ab), shorter(of_bc, of_ca));
}

/// How many dimensions it has: 0 to 2.
WEFT_INLINE int dimensions_of_core(float4 core) {
    return (core.x > 0.0f ? 1 : 0) + (core.y > 0.0f ? 1 : 0) + (core.z > 0.0f ? 1 : 0);
}

/// A corner of the core, from 0 on: around a rectangle, or a segment's ends.
WEFT_INLINE real3 corner_of_core(float4 core, int k) {
    const float first = k == 1 || k == 2 ? -1.0f : 1.0f;
    const float second = k == 2 || k == 3 ? -1.0f : 1.0f;
    const int is_y_second = core.x > 0.0f;
    const int is_z_second = core.x > 0.0f || core.y > 0.0f;
    return make3(splat(first * core.x), splat((is_y_second ? second : first) * core.y),
                 splat((is_z_second ? second : first) * core.z));
}

/// How far a point is from a rectangle's border, seen from above it [m]; negative: it is beyond.
WEFT_INLINE real inside_border(real3 p, float4 core) {
    const real far = splat(3e38f);
    const real x = core.x > 0.0f ? splat(core.x) - larger(p.x, splat(0.0f) - p.x) : far;
    const real y = core.y > 0.0f ? splat(core.y) - larger(p.y, splat(0.0f) - p.y) : far;
    const real z = core.z > 0.0f ? splat(core.z) - larger(p.z, splat(0.0f) - p.z) : far;
    return smaller(x, smaller(y, z));
}

/// Along the rectangle's normal [m].
WEFT_INLINE real height_above(real3 p, float4 core) {
    const real y_or_z = core.y > 0.0f ? p.z : p.y;
    return core.x > 0.0f ? y_or_z : p.x;
}

/// A triangle that lies above a rectangle, all on one side: a corner of it is nearest.
WEFT_INLINE mask lies_above(corners3 t, float4 core) {
    const real border = smaller(inside_border(t.a, core),
                                smaller(inside_border(t.b, core), inside_border(t.c, core)));
    const real a = height_above(t.a, core);
    const real b = height_above(t.b, core);
    const real c = height_above(t.c, core);
    const real lowest = smaller(a, smaller(b, c));
    const real highest = larger(a, larger(b, c));
    const real zero = splat(0.0f);
    return both(border >= zero, larger(lowest, zero - highest) > zero);
}

/// Segments and rectangles in one loop: compilers for OpenCL take long over much code.
WEFT_INLINE way_to_core way_to(corners3 t, float4 core) {
    const int dimensions = dimensions_of_core(core);
    if (dimensions == 0) return from_triangle(t, corner_of_core(core, 0));
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const real3 none = make3(zero, zero, zero);
    way_to_core found = {none, none, splat(3e38f)};
    real edges_count = one;  // 0: a corner is nearest
    if (dimensions == 2) {
        found = from_corner(t.a, make3(one, zero, zero), core);
        found = shorter(found, from_corner(t.b, make3(zero, one, zero), core));
        found = shorter(found, from_corner(t.c, make3(zero, zero, one), core));
        edges_count = lies_above(t, core) ? zero : one;
        if (!any_item(edges_count > zero)) return found;
    }
    const int edges = dimensions == 1 ? 1 : 4;
    for (int k = 0; k < edges; ++k) {
        way_to_core other = from_edges(t, corner_of_core(core, k), corner_of_core(core, k + 1));
        other.square = edges_count > zero ? other.square : splat(3e38f);
        found = shorter(found, other);
    }
    return found;
}

/// Where a triangle and a core are closest.
typedef struct {
    real3 weights;  ///< of the triangle's corners
    real3 at;       ///< the core's point [m]
    real3 normal;   ///< from there to the triangle's, of length 1
    real distance;  ///< [m]
} core_meeting;

/// m where that holds, else the other.
WEFT_INLINE core_meeting choose_meeting(mask holds, core_meeting m, core_meeting other) {
    other.weights = either(holds, m.weights, other.weights);
    other.at = either(holds, m.at, other.at);
    other.normal = either(holds, m.normal, other.normal);
    other.distance = holds ? m.distance : other.distance;
    return other;
}

/// A triangle that the core goes through is seen from where it might get out. Where the two touch,
/// any way out is as short.
WEFT_INLINE core_meeting meet_core(corners3 t, float4 core) {
    const real zero = splat(0.0f);
    const way_to_core found = way_to(t, core);
    core_meeting m;
    m.weights = found.weights;
    m.at = add(weighted3(t, found.weights), found.way);
    m.distance = square_root(found.square);
    const real shrink = splat(-1.0f) / divisor(m.distance);
    m.normal.x = m.distance > zero ? found.way.x * shrink : splat(1.0f);
    m.normal.y = found.way.y * shrink;
    m.normal.z = found.way.z * shrink;
    return m;
}

/// The part of their ways after which corners may come to that distance, as advance_to_contact()
/// in contact.h: the plane between them and the core is passed by a corner first.
WEFT_INLINE real advance_to_core(core_meeting m, corners3 ways, real part, real distance) {
    const real one = splat(1.0f);
    const real gap = m.distance - distance;
    const real growth =
        smaller(smaller(dot3(m.normal, ways.a), dot3(m.normal, ways.b)), dot3(m.normal, ways.c));
    const real next = growth < splat(0.0f) ? smaller(part - gap / growth, one) : one;
    return gap > splat(0.0f) ? next : part;
}

/// Corners bound how fast a triangle comes nearer, so what turns may take many steps to where it
/// meets the core. Each item goes on until it is there, or at its way's end.
#define WEFT_CORE_STEPS 32

/// Nearer than so many radii to the distance to be kept, a triangle has come to the core. What has
/// not, after all steps, is seen from where it ends.
#define WEFT_CORE_REACHED 0.125f

/// A triangle at `end`, seen from the plane of its first contact on the way from `start`, or from
/// where it is, if it is nearer so.
/// there     as seen from there
/// distance  to be kept [m]
WEFT_INLINE core_meeting meet_core_on_way(corners3 start, corners3 end, core_meeting there,
                                          float4 core, real distance) {
    const real close = distance + splat(WEFT_CORE_REACHED * core.w);
    const real one = splat(1.0f);
    corners3 ways;
    ways.a = subtract(end.a, start.a);
    ways.b = subtract(end.b, start.b);
    ways.c = subtract(end.c, start.c);
    real part = splat(0.0f);
    core_meeting m = there;
    for (int k = 0; k <= WEFT_CORE_STEPS; ++k) {
        if (k > 0) {
            if (!any_item(both(m.distance > close, part < one))) break;
            part = m.distance > close ? advance_to_core(m, ways, part, distance) : part;
        }
        m = meet_core(advanced3(start, ways, part), core);
    }
    const mask met = both(m.distance <= close, part < one);
    m.distance = dot3(m.normal, subtract(weighted3(end, m.weights), m.at));
    return choose_meeting(both(met, m.distance < there.distance), m, there);
}

WEFT_KERNELS_END

#endif
