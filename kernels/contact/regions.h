#ifndef WEFT_KERNELS_CONTACT_REGIONS_H
#define WEFT_KERNELS_CONTACT_REGIONS_H

// Which of the pairs of a vertex and a triangle push: one for each face, edge or vertex of the
// surface whose part of space the vertex is in (offset geometric contact, Chen 2025, equations 8
// and 9), so that forces are orthogonal to the surface, and none counts twice.

#include "kernels/contact/closest.h"
#include "kernels/lanes.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// The corners of triangles; of all items at hand one and the same, or one each.
typedef struct {
    whole number, a, b, c;
} triangle_corners;

/// 1 where the closest point is a corner or on an edge; 0 on the face.
WEFT_INLINE whole is_on_rim(real4 weights) {
    const real zero = splat(0.0f);
    const whole one = splat_whole(1);
    return weights.y == zero
               ? one
               : (weights.z == zero ? one : (weights.w == zero ? one : splat_whole(0)));
}

/// 1 where it is a corner.
WEFT_INLINE whole is_corner(real4 weights) {
    const real zero = splat(0.0f);
    const whole one = splat_whole(1);
    const whole none = splat_whole(0);
    const whole y = weights.y == zero ? one : none;
    const whole z = weights.z == zero ? one : none;
    const whole w = weights.w == zero ? one : none;
    return y + z + w > one ? one : none;
}

/// 1 unless the vertex is nearer to the face beyond the edge.
WEFT_INLINE whole is_off_edge(WEFT_GLOBAL const float4* points, WEFT_GLOBAL const int* beyond,
                              whole entry, real3 foot, real3 way) {
    const whole other = gather_whole(beyond, address(entry));
    const mask is_border = other < splat_whole(0);
    const real3 x = xyz(gather4(points, address(is_border ? splat_whole(0) : other)));
    const whole off = dot3(way, subtract(foot, x)) >= splat(0.0f) ? splat_whole(1) : splat_whole(0);
    return is_border ? splat_whole(1) : off;
}

/// 1 unless the vertex is nearer to one of the corner's edges.
WEFT_INLINE whole is_off_corner(WEFT_GLOBAL const float4* points, WEFT_GLOBAL const int* ring_begin,
                                WEFT_GLOBAL const int* ring, whole corner, real3 way) {
    const real3 x = xyz(gather4(points, address(corner)));
    const whole begin = gather_whole(ring_begin, address(corner));
    const whole last = gather_whole(ring_begin, address(corner + splat_whole(1))) - splat_whole(1);
    const int longest = largest_whole(last - begin) + 1;
    whole off = splat_whole(1);
    for (int k = 0; k < longest; ++k) {
        const integer entry = address(smaller_whole(begin + splat_whole(k), last));
        const real3 y = xyz(gather4(points, address(gather_whole(ring, entry))));
        off = dot3(way, subtract(x, y)) < splat(0.0f) ? splat_whole(0) : off;
    }
    return off;
}

/// 1 where a vertex and a triangle push each other, if they are near enough.
/// on        where that matters
/// vertex    its number; two vertices push once
/// points    [vertices] anchors
/// beyond    [3 * triangle_count] column-major: Surface::beyond
/// owned     [6 * triangle_count] column-major: the bits of Surface::owned
/// ring_begin, ring   Surface::ring
WEFT_INLINE whole vertex_triangle_pushes(mask on, whole vertex, triangle_corners t, real3 p,
                                         closest_points c, WEFT_GLOBAL const float4* points,
                                         WEFT_GLOBAL const int* beyond,
                                         WEFT_GLOBAL const int* owned,
                                         WEFT_GLOBAL const int* ring_begin,
                                         WEFT_GLOBAL const int* ring, int triangle_count) {
    const real zero = splat(0.0f);
    const whole none = splat_whole(0);
    const whole rim = is_on_rim(c.weights);
    whole pushes = splat_whole(1) - rim;
    if (any_item(both(on, rim > none))) {
        const whole is_at_corner = is_corner(c.weights);
        const whole edge =
            c.weights.y == zero ? none : (c.weights.z == zero ? splat_whole(1) : splat_whole(2));
        const whole corner =
            c.weights.y != zero ? none : (c.weights.z != zero ? splat_whole(1) : splat_whole(2));
        const whole feature = is_at_corner > none ? corner + splat_whole(3) : edge;
        const whole is_owner =
            gather_whole(owned, address(t.number + feature * splat_whole(triangle_count)));
        const whole entry = t.number + edge * splat_whole(triangle_count);
        whole feasible = is_off_edge(points, beyond, entry, subtract(p, c.way), c.way);
        if (any_item(both(on, is_at_corner * is_owner > none))) {
            const whole at = c.weights.y != zero ? t.a : (c.weights.z != zero ? t.b : t.c);
            const whole off = is_off_corner(points, ring_begin, ring, at, c.way);
            const whole once = vertex < at ? off : none;
            feasible = is_at_corner > none ? once : feasible;
        }
        pushes = rim > none ? is_owner * feasible : pushes;
    }
    return pushes;
}

WEFT_KERNELS_END

#endif
