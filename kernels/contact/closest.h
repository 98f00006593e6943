#ifndef WEFT_KERNELS_CONTACT_CLOSEST_H
#define WEFT_KERNELS_CONTACT_CLOSEST_H

// The closest points of a point and a triangle, and of two segments. Whatever is degenerate (no
// area, no length, parallel, touching) has an answer, too: the least of all candidates, of which
// the first one wins, and no candidate divides by zero.

#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// Two triangles' sides, or two segments, count as parallel if the square of the sine between them
/// is not above this.
#define WEFT_PARALLEL 1e-10f

/// Where two primitives A and B are closest. Weights of A's corners are positive, those of B's
/// negative, their sum is 0; one that is exactly 0 tells that its corner has no part: so a point is
/// closest to an edge or a corner of a triangle, or a segment at one of its ends.
typedef struct {
    real4 weights;
    real3 way;    ///< from B's point to A's: the sum of weight times corner [m]
    real square;  ///< of the distance [m^2]
} closest_points;

WEFT_INLINE real4 make_weights(real a, real b, real c, real d) {
    real4 w = {a, b, c, d};
    return w;
}

WEFT_INLINE closest_points candidate(real4 weights, real3 way) {
    closest_points c = {weights, way, dot3(way, way)};
    return c;
}

/// The nearer one; of equals the first.
WEFT_INLINE closest_points nearer(closest_points a, closest_points b) {
    closest_points c;
    c.weights.x = b.square < a.square ? b.weights.x : a.weights.x;
    c.weights.y = b.square < a.square ? b.weights.y : a.weights.y;
    c.weights.z = b.square < a.square ? b.weights.z : a.weights.z;
    c.weights.w = b.square < a.square ? b.weights.w : a.weights.w;
    c.way.x = b.square < a.square ? b.way.x : a.way.x;
    c.way.y = b.square < a.square ? b.way.y : a.way.y;
    c.way.z = b.square < a.square ? b.way.z : a.way.z;
    c.square = b.square < a.square ? b.square : a.square;
    return c;
}

WEFT_INLINE real between_0_and_1(real s) { return smaller(larger(s, splat(0.0f)), splat(1.0f)); }

/// To divide by: squares of areas are small.
WEFT_INLINE real area_divisor(real square) { return larger(square, splat(1e-30f)); }

/// How far along a segment a point's foot is, from 0 to 1. way: from the segment's begin to the
/// point
WEFT_INLINE real foot_on_segment(real3 way, real3 segment) {
    return between_0_and_1(dot3(way, segment) / divisor(dot3(segment, segment)));
}

/// A candidate that only counts where all three of these are positive.
WEFT_INLINE closest_points if_positive(closest_points c, real u, real v, real w) {
    c.square = smaller(smaller(u, v), w) > splat(0.0f) ? c.square : splat(3e38f);
    return c;
}

/// The face, then its edges ab, bc, ca. weights: of p, a, b, c
WEFT_INLINE closest_points closest_vertex_triangle(real3 p, real3 a, real3 b, real3 c) {
    const real one = splat(1.0f);
    const real zero = splat(0.0f);
    const real3 ab = subtract(b, a);
    const real3 ac = subtract(c, a);
    const real3 bc = subtract(c, b);
    const real3 pa = subtract(p, a);
    const real3 pb = subtract(p, b);
    const real3 normal = cross3(ab, ac);
    const real square = dot3(normal, normal);
    const real least = splat(WEFT_PARALLEL) * dot3(ab, ab) * dot3(ac, ac);
    const real per_area = one / area_divisor(square);
    const real v = dot3(cross3(pa, ac), normal) * per_area;
    const real w = dot3(cross3(ab, pa), normal) * per_area;
    const real u = one - v - w;
    const real3 above = add_scaled(add_scaled(pa, ab, -v), ac, -w);
    closest_points best = if_positive(candidate(make_weights(one, -u, -v, -w), above), u,
                                      smaller(v, w), square - least);
    const real s = foot_on_segment(pa, ab);
    best = nearer(best, candidate(make_weights(one, s - one, -s, zero), add_scaled(pa, ab, -s)));
    const real t = foot_on_segment(pb, bc);
    best = nearer(best, candidate(make_weights(one, zero, t - one, -t), add_scaled(pb, bc, -t)));
    const real q = foot_on_segment(pa, ac);
    return nearer(best, candidate(make_weights(one, q - one, zero, -q), add_scaled(pa, ac, -q)));
}

/// A candidate at s along the first segment and t along the second. way: from b0 to a0
WEFT_INLINE closest_points on_segments(real s, real t, real3 way, real3 u, real3 v) {
    const real one = splat(1.0f);
    return candidate(make_weights(one - s, s, t - one, -t),
                     add_scaled(add_scaled(way, u, s), v, -t));
}

/// Inside of both, then each of the four ends with its foot. weights: of a0, a1, b0, b1
WEFT_INLINE closest_points closest_edges(real3 a0, real3 a1, real3 b0, real3 b1) {
    const real one = splat(1.0f);
    const real zero = splat(0.0f);
    const real3 u = subtract(a1, a0);
    const real3 v = subtract(b1, b0);
    const real3 way = subtract(a0, b0);
    const real3 normal = cross3(u, v);
    const real square = dot3(normal, normal);
    const real least = splat(WEFT_PARALLEL) * dot3(u, u) * dot3(v, v);
    const real per_area = one / area_divisor(square);
    const real s = dot3(cross3(v, way), normal) * per_area;
    const real t = dot3(cross3(u, way), normal) * per_area;
    const real inside = smaller(smaller(s, one - s), smaller(t, one - t));
    closest_points best = if_positive(on_segments(s, t, way, u, v), inside, square - least, one);
    const real3 back = subtract(b0, a0);
    const real3 way_end = subtract(a1, b0);
    const real3 back_end = subtract(b1, a0);
    best = nearer(best, on_segments(zero, foot_on_segment(way, v), way, u, v));
    best = nearer(best, on_segments(one, foot_on_segment(way_end, v), way, u, v));
    best = nearer(best, on_segments(foot_on_segment(back, u), zero, way, u, v));
    return nearer(best, on_segments(foot_on_segment(back_end, u), one, way, u, v));
}

WEFT_KERNELS_END

#endif
