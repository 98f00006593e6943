#ifndef WEFT_KERNELS_CONTACT_PAIRS_H
#define WEFT_KERNELS_CONTACT_PAIRS_H

// Pairs of vertices and triangles, and of edges, that may touch in a substep. Both sides of a pair
// find it, by the same arithmetic in the same order of operands. It is one if the boxes of the two
// overlap, they share no vertex or knot (simulation/contact/knots.h), and their distance d at the
// anchors is such that
//   d < reach + reach + least        they can meet, or
//   d < reach + reach + halo         and they push (regions.h). A reach is half a halo at least,
//                                    and a halo half of the thickness: so all that is nearer than
//                                    the thickness is there.
// An entry of a row is 2 * number of the other one, + 1 if they push. Rows ascend: patches near to
// each other are listed in order, and what is in a patch, too.

#include "kernels/contact/closest.h"
#include "kernels/contact/overlap.h"
#include "kernels/contact/regions.h"

WEFT_KERNELS_BEGIN

WEFT_INLINE real3 splat3(float4 p) { return make3(splat(p.x), splat(p.y), splat(p.z)); }

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

/// Whether one of these patches is near to any.
WEFT_INLINE int any_near(WEFT_GLOBAL const int* near_counts, int first_patch, int last_patch) {
    int most = 0;
    for (int p = first_patch; p <= last_patch; ++p) most += near_counts[p];
    return most > 0;
}

/// Whether a vertex and a triangle have nothing in common, by their knots.
WEFT_INLINE mask differs_from(whole v, whole a, whole b, whole c) {
    return both(v != a, both(v != b, v != c));
}

/// For each vertex the triangles.
/// points      [items] xyz [m], w = reach [m]
/// patches     [items] whose each is
/// near_rows, near_counts, near_others   the table of find_near_patches
/// patch_low, patch_high   [patches] boxes
/// patch_triangles   [patches + 1] where the triangles of each begin
/// corners     [3 * triangle_count] column-major
/// knots       [vertices]
/// low, high   [triangles] boxes; w of high: reach
/// beyond, owned, ring_begin, ring   as in regions.h
/// rows, counts, needs, others       a table, as in kernels/neighbours.h
WEFT_KERNEL(find_triangles, WEFT_GLOBAL const float4* points, WEFT_GLOBAL const int* patches,
            WEFT_GLOBAL const int* near_rows, WEFT_GLOBAL const int* near_counts,
            WEFT_GLOBAL const int* near_others, WEFT_GLOBAL const float4* patch_low,
            WEFT_GLOBAL const float4* patch_high, WEFT_GLOBAL const int* patch_triangles,
            WEFT_GLOBAL const int* corners, WEFT_GLOBAL const int* knots,
            WEFT_GLOBAL const float4* low, WEFT_GLOBAL const float4* high,
            WEFT_GLOBAL const int* beyond, WEFT_GLOBAL const int* owned,
            WEFT_GLOBAL const int* ring_begin, WEFT_GLOBAL const int* ring,
            WEFT_GLOBAL const int* rows, WEFT_GLOBAL int* counts, WEFT_GLOBAL int* needs,
            WEFT_GLOBAL int* others, int item_count, int triangle_count, float halo, float least,
            int instance) {
    open_rows row = open_rows_of(rows, i, item_count);
    const int first_patch = patches[i.first];
    const int last_patch = patches[i.first + i.count - 1];
    if (!any_near(near_counts, first_patch, last_patch)) {
        close_rows(row, counts, needs, i, instance);
        return;
    }
    const real4 x = load4(points, i);
    const real_box box = box_of(x, splat(0.5f * halo));
    const float_box all = around_all(box);
    const whole self = item_numbers(i);
    const whole knot = load_whole(knots, i);
    const whole patch = load_whole(patches, i);
    for (int p = first_patch; p <= last_patch; ++p) {
        const mask mine = patch == splat_whole(p);
        for (int n = 0; n < near_counts[p]; ++n) {
            const int q = near_others[near_rows[p] + WEFT_ROW_STRIDE * n];
            if (!meets(all, patch_low[q], patch_high[q])) continue;
            const int end = patch_triangles[q + 1];
            for (int t = patch_triangles[q]; t < end; ++t) {
                const float4 t_low = low[t];
                const float4 t_high = high[t];
                if (!meets(all, t_low, t_high)) continue;
                const triangle_corners k = {splat_whole(t), splat_whole(corners[t]),
                                            splat_whole(corners[t + triangle_count]),
                                            splat_whole(corners[t + 2 * triangle_count])};
                const mask apart =
                    differs_from(knot, splat_whole(knots[corners[t]]),
                                 splat_whole(knots[corners[t + triangle_count]]),
                                 splat_whole(knots[corners[t + 2 * triangle_count]]));
                const mask on = both(both(mine, overlaps(box, t_low, t_high)), apart);
                if (!any_item(on)) continue;
                const closest_points c = closest_vertex_triangle(
                    xyz(x), splat3(points[corners[t]]), splat3(points[corners[t + triangle_count]]),
                    splat3(points[corners[t + 2 * triangle_count]]));
                const pair_ranges range = ranges_of(x.w, splat(t_high.w), least, halo);
                const mask near = both(on, c.square < range.to_push);
                if (!any_item(near)) continue;
                const whole pushes =
                    vertex_triangle_pushes(near, self, k, xyz(x), c, points, beyond, owned,
                                           ring_begin, ring, triangle_count);
                row = with_entry(row, both(on, is_pair(c.square, pushes, range)), others,
                                 splat_whole(2 * t) + pushes);
            }
        }
    }
    close_rows(row, counts, needs, i, instance);
}

/// For each triangle the vertices: the same pairs. Parameters as above; low, high: of the items;
/// patch_vertices: [patches + 1]
WEFT_KERNEL(find_vertices, WEFT_GLOBAL const float4* points, WEFT_GLOBAL const int* patches,
            WEFT_GLOBAL const int* near_rows, WEFT_GLOBAL const int* near_counts,
            WEFT_GLOBAL const int* near_others, WEFT_GLOBAL const float4* patch_low,
            WEFT_GLOBAL const float4* patch_high, WEFT_GLOBAL const int* patch_vertices,
            WEFT_GLOBAL const int* corners, WEFT_GLOBAL const int* knots,
            WEFT_GLOBAL const float4* low, WEFT_GLOBAL const float4* high,
            WEFT_GLOBAL const int* beyond, WEFT_GLOBAL const int* owned,
            WEFT_GLOBAL const int* ring_begin, WEFT_GLOBAL const int* ring,
            WEFT_GLOBAL const int* rows, WEFT_GLOBAL int* counts, WEFT_GLOBAL int* needs,
            WEFT_GLOBAL int* others, int item_count, float halo, float least, int instance) {
    open_rows row = open_rows_of(rows, i, item_count);
    const int first_patch = patches[i.first];
    const int last_patch = patches[i.first + i.count - 1];
    if (!any_near(near_counts, first_patch, last_patch)) {
        close_rows(row, counts, needs, i, instance);
        return;
    }
    const triangle_corners k = {item_numbers(i), load_whole(corners, i),
                                load_whole(corners, column(i, item_count, 1)),
                                load_whole(corners, column(i, item_count, 2))};
    const triangle_corners knot = {k.number, gather_whole(knots, address(k.a)),
                                   gather_whole(knots, address(k.b)),
                                   gather_whole(knots, address(k.c))};
    const real3 a = xyz(gather4(points, address(k.a)));
    const real3 b = xyz(gather4(points, address(k.b)));
    const real3 c = xyz(gather4(points, address(k.c)));
    const real4 top = load4(high, i);
    real_box box;
    box.low = xyz(load4(low, i));
    box.high = xyz(top);
    const float_box all = around_all(box);
    const whole patch = load_whole(patches, i);
    for (int p = first_patch; p <= last_patch; ++p) {
        const mask mine = patch == splat_whole(p);
        for (int n = 0; n < near_counts[p]; ++n) {
            const int q = near_others[near_rows[p] + WEFT_ROW_STRIDE * n];
            if (!meets(all, patch_low[q], patch_high[q])) continue;
            const int end = patch_vertices[q + 1];
            for (int v = patch_vertices[q]; v < end; ++v) {
                const float4 x = points[v];
                const float out = x.w + 0.5f * halo;
                const float4 v_low = {x.x - out, x.y - out, x.z - out, 0.0f};
                const float4 v_high = {x.x + out, x.y + out, x.z + out, 0.0f};
                if (!meets(all, v_low, v_high)) continue;
                const whole vertex = splat_whole(v);
                const mask on = both(both(mine, overlaps(box, v_low, v_high)),
                                     differs_from(splat_whole(knots[v]), knot.a, knot.b, knot.c));
                if (!any_item(on)) continue;
                const closest_points near_by = closest_vertex_triangle(splat3(x), a, b, c);
                const pair_ranges range = ranges_of(splat(x.w), top.w, least, halo);
                const mask near = both(on, near_by.square < range.to_push);
                if (!any_item(near)) continue;
                const whole pushes =
                    vertex_triangle_pushes(near, vertex, k, splat3(x), near_by, points, beyond,
                                           owned, ring_begin, ring, item_count);
                row = with_entry(row, both(on, is_pair(near_by.square, pushes, range)), others,
                                 splat_whole(2 * v) + pushes);
            }
        }
    }
    close_rows(row, counts, needs, i, instance);
}

/// Whether two edges are farther apart than that, at a third of the price of closest_edges(): some
/// that are, are not seen; none that is not, is taken for one. Here the system of two equations
/// will do (Ericson 2005, 5.1.9): where edges are nearly parallel, it errs by some 1e-7 of their
/// squares.
WEFT_INLINE mask edges_are_apart(real3 a0, real3 a1, real3 b0, real3 b1, real square) {
    const real3 u = subtract(a1, a0);
    const real3 v = subtract(b1, b0);
    const real3 way = subtract(a0, b0);
    const real uu = dot3(u, u);
    const real uv = dot3(u, v);
    const real vv = dot3(v, v);
    const real uw = dot3(u, way);
    const real vw = dot3(v, way);
    real s = between_0_and_1((uv * vw - vv * uw) / area_divisor(uu * vv - uv * uv));
    const real t = between_0_and_1((uv * s + vw) / divisor(vv));
    s = between_0_and_1((uv * t - uw) / divisor(uu));
    const real3 gap = add_scaled(add_scaled(way, u, s), v, -t);
    return dot3(gap, gap) > splat(1.01f) * square + splat(1e-5f) * (uu + vv);
}

WEFT_INLINE real3 either(mask m, real3 a, real3 b) {
    return make3(m ? a.x : b.x, m ? a.y : b.y, m ? a.z : b.z);
}

/// 1 where the closest points are inside of both edges.
WEFT_INLINE whole edges_push(closest_points c) {
    const real zero = splat(0.0f);
    const whole none = splat_whole(0);
    const whole inside_b =
        c.weights.z != zero ? (c.weights.w != zero ? splat_whole(1) : none) : none;
    return c.weights.x != zero ? (c.weights.y != zero ? inside_b : none) : none;
}

/// For each edge the edges. Parameters as above; low, high: of the items;
/// patch_edges: [patches + 1]
/// ends        [2 * item_count] column-major
WEFT_KERNEL(find_edges, WEFT_GLOBAL const float4* points, WEFT_GLOBAL const int* patches,
            WEFT_GLOBAL const int* near_rows, WEFT_GLOBAL const int* near_counts,
            WEFT_GLOBAL const int* near_others, WEFT_GLOBAL const float4* patch_low,
            WEFT_GLOBAL const float4* patch_high, WEFT_GLOBAL const int* patch_edges,
            WEFT_GLOBAL const int* ends, WEFT_GLOBAL const int* knots,
            WEFT_GLOBAL const float4* low, WEFT_GLOBAL const float4* high,
            WEFT_GLOBAL const int* rows, WEFT_GLOBAL int* counts, WEFT_GLOBAL int* needs,
            WEFT_GLOBAL int* others, int item_count, float halo, float least, int instance) {
    open_rows row = open_rows_of(rows, i, item_count);
    const int first_patch = patches[i.first];
    const int last_patch = patches[i.first + i.count - 1];
    if (!any_near(near_counts, first_patch, last_patch)) {
        close_rows(row, counts, needs, i, instance);
        return;
    }
    const whole self = item_numbers(i);
    const whole a = load_whole(ends, i);
    const whole b = load_whole(ends, column(i, item_count, 1));
    const whole knot_a = gather_whole(knots, address(a));
    const whole knot_b = gather_whole(knots, address(b));
    const real3 x = xyz(gather4(points, address(a)));
    const real3 y = xyz(gather4(points, address(b)));
    const real4 top = load4(high, i);
    real_box box;
    box.low = xyz(load4(low, i));
    box.high = xyz(top);
    const float_box all = around_all(box);
    const whole patch = load_whole(patches, i);
    for (int p = first_patch; p <= last_patch; ++p) {
        const mask mine = patch == splat_whole(p);
        for (int n = 0; n < near_counts[p]; ++n) {
            const int q = near_others[near_rows[p] + WEFT_ROW_STRIDE * n];
            if (!meets(all, patch_low[q], patch_high[q])) continue;
            const int end = patch_edges[q + 1];
            for (int e = patch_edges[q]; e < end; ++e) {
                const float4 e_low = low[e];
                const float4 e_high = high[e];
                if (!meets(all, e_low, e_high)) continue;
                const whole u = splat_whole(knots[ends[e]]);
                const whole v = splat_whole(knots[ends[e + item_count]]);
                const mask apart =
                    both(both(knot_a != u, knot_a != v), both(knot_b != u, knot_b != v));
                const mask on = both(both(mine, overlaps(box, e_low, e_high)), apart);
                if (!any_item(on)) continue;
                const mask in_order = self < splat_whole(e);
                const real3 z0 = splat3(points[ends[e]]);
                const real3 z1 = splat3(points[ends[e + item_count]]);
                const real3 a0 = either(in_order, x, z0);
                const real3 a1 = either(in_order, y, z1);
                const real3 b0 = either(in_order, z0, x);
                const real3 b1 = either(in_order, z1, y);
                const pair_ranges range = ranges_of(top.w, splat(e_high.w), least, halo);
                const mask far = edges_are_apart(a0, a1, b0, b1, range.to_push);
                const whole near = far ? splat_whole(0) : splat_whole(1);
                const mask perhaps = both(on, near > splat_whole(0));
                if (!any_item(perhaps)) continue;
                const closest_points c = closest_edges(a0, a1, b0, b1);
                const whole pushes = edges_push(c);
                row = with_entry(row, both(perhaps, is_pair(c.square, pushes, range)), others,
                                 splat_whole(2 * e) + pushes);
            }
        }
    }
    close_rows(row, counts, needs, i, instance);
}

WEFT_KERNELS_END

#endif
