#ifndef WEFT_KERNELS_CONTACT_PAIRS_H
#define WEFT_KERNELS_CONTACT_PAIRS_H

// Pairs of vertices and triangles, and of edges, that may touch in a substep. Both sides of a pair
// find it, by the same arithmetic in the same order of operands. It is one if it is a candidate
// (candidates.h: so they share no vertex or knot, see simulation/contact/knots.h), the boxes of the
// two overlap, and their distance d at the anchors is such that
//   d < reach + reach + least        they can meet, or
//   d < reach + reach + halo         and they push (regions.h). A reach is half a halo at least,
//                                    and a halo half of the thickness: so all that is nearer than
//                                    the thickness is there.
// An entry of a row is 2 * number of the other one, + 1 if they push. Rows ascend, as candidates
// do.

#include "kernels/choice.h"
#include "kernels/contact/candidates.h"
#include "kernels/contact/regions.h"

WEFT_KERNELS_BEGIN

/// How near two of that reach have to be.
typedef struct {
    real to_meet, to_push;  ///< squares [m^2]
} pair_ranges;

WEFT_INLINE pair_ranges ranges_of(real reach, real other_reach, float least, float halo) {
    const real sum = reach + other_reach;
    const real meet = sum + splat(least);
    const real push = sum + splat(halo);
    pair_ranges r = {meet * meet, push * push};
    return r;
}

WEFT_INLINE mask is_pair(real square, whole pushes, pair_ranges r) {
    return square < (pushes > splat_whole(0) ? r.to_push : r.to_meet);
}

/// Whether something is to be done about the pairs of these patches: of those that had no patch
/// near to them, and have none, they are known. (A patch that has one near to it keeps one, or is
/// stale.)
WEFT_INLINE int has_work(WEFT_GLOBAL const int* kept_counts, WEFT_GLOBAL const int* stale,
                         int first_patch, int last_patch, int instance) {
    return instance == 0 || any_in_range(kept_counts, first_patch, last_patch) ||
           any_in_range(stale, first_patch, last_patch);
}

/// The same for items by themselves.
WEFT_INLINE whole is_at_work(WEFT_GLOBAL const int* kept_counts, WEFT_GLOBAL const int* stale,
                             WEFT_GLOBAL const int* patches, item i, int instance) {
    const integer patch = load_index(patches, i);
    const whole work = larger_whole(gather_whole(kept_counts, patch), gather_whole(stale, patch));
    return instance == 0 ? splat_whole(1) : work;
}

/// Candidate k of each item; 0 where it has none.
WEFT_INLINE whole candidate_at(WEFT_GLOBAL const int* candidates, whole start, mask on, int k) {
    const whole place = on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start;
    const whole listed = gather_whole(candidates, address(place));
    return on ? listed : splat_whole(0);
}

/// A triangle each, or an edge: where it is, and its box with its reach.
typedef struct {
    real3 a, b, c;
    real_box box;
    real reach;
} placed;

/// margin   of boxes, as in enclose_primitives [m]
WEFT_INLINE placed place_edge(real4 a, real4 b, real margin) {
    placed p;
    p.a = xyz(a);
    p.b = p.c = xyz(b);
    p.box = united(box_of(a, margin), box_of(b, margin));
    p.reach = larger(a.w, b.w);
    return p;
}

WEFT_INLINE placed place_triangle(real4 a, real4 b, real4 c, real margin) {
    placed p = place_edge(a, b, margin);
    p.c = xyz(c);
    p.box = united(p.box, box_of(c, margin));
    p.reach = larger(p.reach, c.w);
    return p;
}

WEFT_INLINE triangle_corners gather_corners(WEFT_GLOBAL const int* corners, whole triangle,
                                            int triangle_count) {
    const whole second = triangle + splat_whole(triangle_count);
    const whole third = second + splat_whole(triangle_count);
    triangle_corners k = {triangle, gather_whole(corners, address(triangle)),
                          gather_whole(corners, address(second)),
                          gather_whole(corners, address(third))};
    return k;
}

WEFT_INLINE placed gather_triangle(WEFT_GLOBAL const float4* points, triangle_corners k,
                                   real margin) {
    return place_triangle(gather4(points, address(k.a)), gather4(points, address(k.b)),
                          gather4(points, address(k.c)), margin);
}

/// The row of a vertex and a triangle each, with the other one where they are a pair.
/// on       where there are two
/// entry    2 * the other one
WEFT_INLINE open_rows with_vertex_and_triangle(
    open_rows row, mask on, whole vertex, real4 x, triangle_corners k, placed t, whole entry,
    WEFT_GLOBAL const float4* points, WEFT_GLOBAL const int* beyond, WEFT_GLOBAL const int* owned,
    WEFT_GLOBAL const int* ring_begin, WEFT_GLOBAL const int* ring, WEFT_GLOBAL int* others,
    int triangle_count, float halo, float least) {
    const mask meet = both(on, overlap(box_of(x, splat(0.5f * halo)), t.box));
    if (any_item(meet)) {
        const closest_points c = closest_vertex_triangle(xyz(x), t.a, t.b, t.c);
        const pair_ranges range = ranges_of(x.w, t.reach, least, halo);
        const mask near = both(meet, c.square < range.to_push);
        const whole none = splat_whole(0);
        whole pushes = none;
        if (any_item(near)) {
            pushes = vertex_triangle_pushes(near, vertex, k, xyz(x), c, points, beyond, owned,
                                            ring_begin, ring, triangle_count);
            pushes = near ? pushes : none;
        }
        row = with_entry(row, both(meet, is_pair(c.square, pushes, range)), others, entry + pushes);
    }
    return row;
}

/// For each vertex the triangles.
/// points      [items] xyz [m], w = reach [m]
/// patches     [items] whose each is
/// near_counts [patches] how many patches are near
/// kept_counts, stale  [patches] as check_candidates leaves them
/// candidate_rows, candidate_counts, candidates   the table of collect_triangles
/// corners     [3 * triangle_count] column-major
/// beyond, owned, ring_begin, ring   as in regions.h
/// rows, counts, needs, others       a table, as in kernels/neighbours.h
WEFT_NARROW_KERNEL(find_triangles, WEFT_GLOBAL const float4* points, WEFT_GLOBAL const int* patches,
                   WEFT_GLOBAL const int* near_counts, WEFT_GLOBAL const int* kept_counts,
                   WEFT_GLOBAL const int* stale, WEFT_GLOBAL const int* candidate_rows,
                   WEFT_GLOBAL const int* candidate_counts, WEFT_GLOBAL const int* candidates,
                   WEFT_GLOBAL const int* corners, WEFT_GLOBAL const int* beyond,
                   WEFT_GLOBAL const int* owned, WEFT_GLOBAL const int* ring_begin,
                   WEFT_GLOBAL const int* ring, WEFT_GLOBAL const int* rows,
                   WEFT_GLOBAL int* counts, WEFT_GLOBAL int* needs, WEFT_GLOBAL int* others,
                   int item_count, int triangle_count, float halo, float least, int instance) {
    const int first_patch = patches[i.first];
    const int last_patch = patches[i.first + i.count - 1];
    if (has_work(kept_counts, stale, first_patch, last_patch, instance)) {
        const whole anew = is_at_work(kept_counts, stale, patches, i, instance);
        open_rows row = emptied_rows(rows, counts, anew, i, item_count);
        if (any_in_range(near_counts, first_patch, last_patch)) {
            const real4 x = load4(points, i);
            const whole self = item_numbers(i);
            const whole start = load_whole(candidate_rows, i);
            const whole count =
                anew > splat_whole(0) ? load_whole(candidate_counts, i) : splat_whole(0);
            const int longest = largest_whole(count);
            for (int n = 0; n < longest; ++n) {
                const mask on = splat_whole(n) < count;
                const whole t = candidate_at(candidates, start, on, n);
                const triangle_corners k = gather_corners(corners, t, triangle_count);
                const placed triangle = gather_triangle(points, k, splat(0.5f * halo));
                row = with_vertex_and_triangle(row, on, self, x, k, triangle, t + t, points, beyond,
                                               owned, ring_begin, ring, others, triangle_count,
                                               halo, least);
            }
        }
        close_emptied_rows(row, anew, counts, needs, i, instance);
    }
}

/// For each triangle the vertices: the same pairs. Parameters as above
WEFT_NARROW_KERNEL(find_vertices, WEFT_GLOBAL const float4* points, WEFT_GLOBAL const int* patches,
                   WEFT_GLOBAL const int* near_counts, WEFT_GLOBAL const int* kept_counts,
                   WEFT_GLOBAL const int* stale, WEFT_GLOBAL const int* candidate_rows,
                   WEFT_GLOBAL const int* candidate_counts, WEFT_GLOBAL const int* candidates,
                   WEFT_GLOBAL const int* corners, WEFT_GLOBAL const int* beyond,
                   WEFT_GLOBAL const int* owned, WEFT_GLOBAL const int* ring_begin,
                   WEFT_GLOBAL const int* ring, WEFT_GLOBAL const int* rows,
                   WEFT_GLOBAL int* counts, WEFT_GLOBAL int* needs, WEFT_GLOBAL int* others,
                   int item_count, float halo, float least, int instance) {
    const int first_patch = patches[i.first];
    const int last_patch = patches[i.first + i.count - 1];
    if (has_work(kept_counts, stale, first_patch, last_patch, instance)) {
        const whole anew = is_at_work(kept_counts, stale, patches, i, instance);
        open_rows row = emptied_rows(rows, counts, anew, i, item_count);
        if (any_in_range(near_counts, first_patch, last_patch)) {
            const triangle_corners k = gather_corners(corners, item_numbers(i), item_count);
            const placed triangle = gather_triangle(points, k, splat(0.5f * halo));
            const whole start = load_whole(candidate_rows, i);
            const whole count =
                anew > splat_whole(0) ? load_whole(candidate_counts, i) : splat_whole(0);
            const int longest = largest_whole(count);
            for (int n = 0; n < longest; ++n) {
                const mask on = splat_whole(n) < count;
                const whole v = candidate_at(candidates, start, on, n);
                const real4 x = gather4(points, address(v));
                row = with_vertex_and_triangle(row, on, v, x, k, triangle, v + v, points, beyond,
                                               owned, ring_begin, ring, others, item_count, halo,
                                               least);
            }
        }
        close_emptied_rows(row, anew, counts, needs, i, instance);
    }
}

/// 1 where the closest points are inside of both edges.
WEFT_INLINE whole edges_push(closest_points c) {
    const real zero = splat(0.0f);
    const whole none = splat_whole(0);
    const whole inside_b =
        c.weights.z != zero ? (c.weights.w != zero ? splat_whole(1) : none) : none;
    return c.weights.x != zero ? (c.weights.y != zero ? inside_b : none) : none;
}

/// For each edge the edges. Parameters as above;
/// ends        [2 * item_count] column-major
WEFT_NARROW_KERNEL(find_edges, WEFT_GLOBAL const float4* points, WEFT_GLOBAL const int* patches,
                   WEFT_GLOBAL const int* near_counts, WEFT_GLOBAL const int* kept_counts,
                   WEFT_GLOBAL const int* stale, WEFT_GLOBAL const int* candidate_rows,
                   WEFT_GLOBAL const int* candidate_counts, WEFT_GLOBAL const int* candidates,
                   WEFT_GLOBAL const int* ends, WEFT_GLOBAL const int* rows,
                   WEFT_GLOBAL int* counts, WEFT_GLOBAL int* needs, WEFT_GLOBAL int* others,
                   int item_count, float halo, float least, int instance) {
    const int first_patch = patches[i.first];
    const int last_patch = patches[i.first + i.count - 1];
    if (has_work(kept_counts, stale, first_patch, last_patch, instance)) {
        const whole anew = is_at_work(kept_counts, stale, patches, i, instance);
        open_rows row = emptied_rows(rows, counts, anew, i, item_count);
        if (any_in_range(near_counts, first_patch, last_patch)) {
            const real margin = splat(0.5f * halo);
            const whole self = item_numbers(i);
            const placed own =
                place_edge(gather4(points, load_index(ends, i)),
                           gather4(points, load_index(ends, column(i, item_count, 1))), margin);
            const whole start = load_whole(candidate_rows, i);
            const whole count =
                anew > splat_whole(0) ? load_whole(candidate_counts, i) : splat_whole(0);
            const int longest = largest_whole(count);
            for (int n = 0; n < longest; ++n) {
                const mask on = splat_whole(n) < count;
                const whole e = candidate_at(candidates, start, on, n);
                const integer end0 = address(gather_whole(ends, address(e)));
                const integer end1 =
                    address(gather_whole(ends, address(e + splat_whole(item_count))));
                const placed other =
                    place_edge(gather4(points, end0), gather4(points, end1), margin);
                const mask meet = both(on, overlap(own.box, other.box));
                if (!any_item(meet)) continue;
                const mask in_order = self < e;
                const closest_points c = closest_edges(
                    either(in_order, own.a, other.a), either(in_order, own.b, other.b),
                    either(in_order, other.a, own.a), either(in_order, other.b, own.b));
                const pair_ranges range = ranges_of(own.reach, other.reach, least, halo);
                const whole pushes = edges_push(c);
                row = with_entry(row, both(meet, is_pair(c.square, pushes, range)), others,
                                 e + e + pushes);
            }
        }
        close_emptied_rows(row, anew, counts, needs, i, instance);
    }
}

WEFT_KERNELS_END

#endif
