#ifndef WEFT_KERNELS_CONTACT_CANDIDATES_H
#define WEFT_KERNELS_CONTACT_CANDIDATES_H

// Candidates for pairs (pairs.h): all that would be one if its items were nearer to each other by a
// slack. Patches that are stale (nearing.h) collect them anew; the others' are left as they are.
// Rows ascend: patches near to each other are listed in order, and what is in a patch, too.

#include "kernels/contact/closest.h"
#include "kernels/contact/overlap.h"

WEFT_KERNELS_BEGIN

WEFT_INLINE real3 splat3(float4 p) { return make3(splat(p.x), splat(p.y), splat(p.z)); }

/// The rows of the items at hand, those that are filled anew empty.
/// anew  not 0 for these
WEFT_INLINE open_rows emptied_rows(WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* counts,
                                   whole anew, item i, int item_count) {
    open_rows row = open_rows_of(rows, i, item_count);
    row.count = anew > splat_whole(0) ? row.count : load_whole(counts, i);
    return row;
}

/// Others stay as they are.
WEFT_INLINE void close_emptied_rows(open_rows row, whole anew, WEFT_GLOBAL int* counts,
                                    WEFT_GLOBAL int* needs, item i, int instance) {
    const whole before = load_whole(needs, i);
    const whole most = instance == 0 ? row.count : larger_whole(row.count, before);
    store_whole(counts, i, smaller_whole(row.count, row.room));
    store_whole(needs, i, anew > splat_whole(0) ? most : before);
}

/// The square of how near two of that reach have to be [m^2]. by: the halo or what bodies keep in
/// any case, whichever is more, and the slack
WEFT_INLINE real near_square(real reach, real other_reach, real by) {
    const real range = reach + other_reach + by;
    return range * range;
}

/// Whether a vertex and a triangle have nothing in common, by their knots.
WEFT_INLINE mask differs_from(whole v, whole a, whole b, whole c) {
    return both(v != a, both(v != b, v != c));
}

/// For each vertex the triangles.
/// points      [items] xyz [m], w = reach [m]
/// patches     [items] whose each is
/// near_rows, near_counts, near_others   the table of find_near_patches
/// stale, slacks   [patches] as check_candidates leaves them
/// patch_low, patch_high   [patches] boxes
/// patch_triangles   [patches + 1] where the triangles of each begin
/// corners     [3 * triangle_count] column-major
/// knots       [vertices]
/// low, high   [triangles] boxes; w of high: reach
/// rows, counts, needs, others       a table, as in kernels/neighbours.h; but needs of rows that
///             are left as they are stay, too
/// range       from where on what is near pushes, or would pass through, reaches aside [m]
/// spare       by how much nearer it is looked for than slack asks for: for rounding [m]
WEFT_NARROW_KERNEL(collect_triangles, WEFT_GLOBAL const float4* points,
                   WEFT_GLOBAL const int* patches, WEFT_GLOBAL const int* near_rows,
                   WEFT_GLOBAL const int* near_counts, WEFT_GLOBAL const int* near_others,
                   WEFT_GLOBAL const int* stale, WEFT_GLOBAL const float* slacks,
                   WEFT_GLOBAL const float4* patch_low, WEFT_GLOBAL const float4* patch_high,
                   WEFT_GLOBAL const int* patch_triangles, WEFT_GLOBAL const int* corners,
                   WEFT_GLOBAL const int* knots, WEFT_GLOBAL const float4* low,
                   WEFT_GLOBAL const float4* high, WEFT_GLOBAL const int* rows,
                   WEFT_GLOBAL int* counts, WEFT_GLOBAL int* needs, WEFT_GLOBAL int* others,
                   int item_count, int triangle_count, float halo, float range, float spare,
                   int instance) {
    const int first_patch = patches[i.first];
    const int last_patch = patches[i.first + i.count - 1];
    if (any_in_range(stale, first_patch, last_patch)) {
        const whole patch = load_whole(patches, i);
        const whole is_stale = gather_whole(stale, address(patch));
        open_rows row = emptied_rows(rows, counts, is_stale, i, item_count);
        const real4 x = load4(points, i);
        const real slack = gather(slacks, address(patch)) + splat(spare);
        const real_box box = widened(box_of(x, splat(0.5f * halo)), slack);
        const float_box all = around_all(box);
        const whole knot = load_whole(knots, i);
        for (int p = first_patch; p <= last_patch; ++p) {
            const mask mine = patch == splat_whole(p);
            const int near_count = stale[p] != 0 ? near_counts[p] : 0;
            for (int n = 0; n < near_count; ++n) {
                const int q = near_others[near_rows[p] + WEFT_ROW_STRIDE * n];
                if (!meets(all, patch_low[q], patch_high[q])) continue;
                const int end = patch_triangles[q + 1];
                for (int t = patch_triangles[q]; t < end; ++t) {
                    const float4 t_low = low[t];
                    const float4 t_high = high[t];
                    const mask meet = both(mine, overlaps(box, t_low, t_high));
                    if (!any_item(meet)) continue;
                    const int a = corners[t];
                    const int b = corners[t + triangle_count];
                    const int c = corners[t + 2 * triangle_count];
                    const mask apart = differs_from(knot, splat_whole(knots[a]),
                                                    splat_whole(knots[b]), splat_whole(knots[c]));
                    const mask on = both(meet, apart);
                    if (!any_item(on)) continue;
                    const closest_points closest = closest_vertex_triangle(
                        xyz(x), splat3(points[a]), splat3(points[b]), splat3(points[c]));
                    const real square = near_square(x.w, splat(t_high.w), splat(range) + slack);
                    row =
                        with_entry(row, both(on, closest.square < square), others, splat_whole(t));
                }
            }
        }
        close_emptied_rows(row, is_stale, counts, needs, i, instance);
    }
}

/// For each triangle the vertices: the same candidates. Parameters as above; low, high: of the
/// items; patch_vertices: [patches + 1]
WEFT_NARROW_KERNEL(collect_vertices, WEFT_GLOBAL const float4* points,
                   WEFT_GLOBAL const int* patches, WEFT_GLOBAL const int* near_rows,
                   WEFT_GLOBAL const int* near_counts, WEFT_GLOBAL const int* near_others,
                   WEFT_GLOBAL const int* stale, WEFT_GLOBAL const float* slacks,
                   WEFT_GLOBAL const float4* patch_low, WEFT_GLOBAL const float4* patch_high,
                   WEFT_GLOBAL const int* patch_vertices, WEFT_GLOBAL const int* corners,
                   WEFT_GLOBAL const int* knots, WEFT_GLOBAL const float4* low,
                   WEFT_GLOBAL const float4* high, WEFT_GLOBAL const int* rows,
                   WEFT_GLOBAL int* counts, WEFT_GLOBAL int* needs, WEFT_GLOBAL int* others,
                   int item_count, float halo, float range, float spare, int instance) {
    const int first_patch = patches[i.first];
    const int last_patch = patches[i.first + i.count - 1];
    if (any_in_range(stale, first_patch, last_patch)) {
        const whole patch = load_whole(patches, i);
        const whole is_stale = gather_whole(stale, address(patch));
        open_rows row = emptied_rows(rows, counts, is_stale, i, item_count);
        const integer at_a = load_index(corners, i);
        const integer at_b = load_index(corners, column(i, item_count, 1));
        const integer at_c = load_index(corners, column(i, item_count, 2));
        const whole knot_a = gather_whole(knots, at_a);
        const whole knot_b = gather_whole(knots, at_b);
        const whole knot_c = gather_whole(knots, at_c);
        const real3 a = xyz(gather4(points, at_a));
        const real3 b = xyz(gather4(points, at_b));
        const real3 c = xyz(gather4(points, at_c));
        const real slack = gather(slacks, address(patch)) + splat(spare);
        const real4 top = load4(high, i);
        real_box box;
        box.low = xyz(load4(low, i));
        box.high = xyz(top);
        box = widened(box, slack);
        const float_box all = around_all(box);
        for (int p = first_patch; p <= last_patch; ++p) {
            const mask mine = patch == splat_whole(p);
            const int near_count = stale[p] != 0 ? near_counts[p] : 0;
            for (int n = 0; n < near_count; ++n) {
                const int q = near_others[near_rows[p] + WEFT_ROW_STRIDE * n];
                if (!meets(all, patch_low[q], patch_high[q])) continue;
                const int end = patch_vertices[q + 1];
                for (int v = patch_vertices[q]; v < end; ++v) {
                    const float4 x = points[v];
                    const float out = x.w + 0.5f * halo;
                    const float4 v_low = {x.x - out, x.y - out, x.z - out, 0.0f};
                    const float4 v_high = {x.x + out, x.y + out, x.z + out, 0.0f};
                    const mask meet = both(mine, overlaps(box, v_low, v_high));
                    if (!any_item(meet)) continue;
                    const mask apart = differs_from(splat_whole(knots[v]), knot_a, knot_b, knot_c);
                    const mask on = both(meet, apart);
                    if (!any_item(on)) continue;
                    const closest_points closest = closest_vertex_triangle(splat3(x), a, b, c);
                    const real square = near_square(splat(x.w), top.w, splat(range) + slack);
                    row =
                        with_entry(row, both(on, closest.square < square), others, splat_whole(v));
                }
            }
        }
        close_emptied_rows(row, is_stale, counts, needs, i, instance);
    }
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

/// For each edge the edges. Parameters as above; low, high: of the items;
/// patch_edges: [patches + 1]
/// ends        [2 * item_count] column-major
WEFT_NARROW_KERNEL(collect_edges, WEFT_GLOBAL const float4* points, WEFT_GLOBAL const int* patches,
                   WEFT_GLOBAL const int* near_rows, WEFT_GLOBAL const int* near_counts,
                   WEFT_GLOBAL const int* near_others, WEFT_GLOBAL const int* stale,
                   WEFT_GLOBAL const float* slacks, WEFT_GLOBAL const float4* patch_low,
                   WEFT_GLOBAL const float4* patch_high, WEFT_GLOBAL const int* patch_edges,
                   WEFT_GLOBAL const int* ends, WEFT_GLOBAL const int* knots,
                   WEFT_GLOBAL const float4* low, WEFT_GLOBAL const float4* high,
                   WEFT_GLOBAL const int* rows, WEFT_GLOBAL int* counts, WEFT_GLOBAL int* needs,
                   WEFT_GLOBAL int* others, int item_count, float range, float spare,
                   int instance) {
    const int first_patch = patches[i.first];
    const int last_patch = patches[i.first + i.count - 1];
    if (any_in_range(stale, first_patch, last_patch)) {
        const whole patch = load_whole(patches, i);
        const whole is_stale = gather_whole(stale, address(patch));
        open_rows row = emptied_rows(rows, counts, is_stale, i, item_count);
        const integer at_a = load_index(ends, i);
        const integer at_b = load_index(ends, column(i, item_count, 1));
        const whole knot_a = gather_whole(knots, at_a);
        const whole knot_b = gather_whole(knots, at_b);
        const real3 a0 = xyz(gather4(points, at_a));
        const real3 a1 = xyz(gather4(points, at_b));
        const real slack = gather(slacks, address(patch)) + splat(spare);
        const real4 top = load4(high, i);
        real_box box;
        box.low = xyz(load4(low, i));
        box.high = xyz(top);
        box = widened(box, slack);
        const float_box all = around_all(box);
        for (int p = first_patch; p <= last_patch; ++p) {
            const mask mine = patch == splat_whole(p);
            const int near_count = stale[p] != 0 ? near_counts[p] : 0;
            for (int n = 0; n < near_count; ++n) {
                const int q = near_others[near_rows[p] + WEFT_ROW_STRIDE * n];
                if (!meets(all, patch_low[q], patch_high[q])) continue;
                const int end = patch_edges[q + 1];
                for (int e = patch_edges[q]; e < end; ++e) {
                    const float4 e_low = low[e];
                    const float4 e_high = high[e];
                    const mask meet = both(mine, overlaps(box, e_low, e_high));
                    if (!any_item(meet)) continue;
                    const int b = ends[e];
                    const int c = ends[e + item_count];
                    const whole u = splat_whole(knots[b]);
                    const whole v = splat_whole(knots[c]);
                    const mask apart =
                        both(both(knot_a != u, knot_a != v), both(knot_b != u, knot_b != v));
                    const mask on = both(meet, apart);
                    if (!any_item(on)) continue;
                    const real square = near_square(top.w, splat(e_high.w), splat(range) + slack);
                    const mask far =
                        edges_are_apart(a0, a1, splat3(points[b]), splat3(points[c]), square);
                    const whole near = far ? splat_whole(0) : splat_whole(1);
                    row = with_entry(row, both(on, near > splat_whole(0)), others, splat_whole(e));
                }
            }
        }
        close_emptied_rows(row, is_stale, counts, needs, i, instance);
    }
}

WEFT_KERNELS_END

#endif
