#ifndef WEFT_KERNELS_CONTACT_FILL_H
#define WEFT_KERNELS_CONTACT_FILL_H

// From the pairs of primitives that detection found to rows of contacts and planes, one per vertex.
// Each vertex computes all of its contacts itself, in the order of operands that all four vertices
// of a contact use: so all four see the same numbers.

#include "kernels/columns.h"
#include "kernels/contact/boxes.h"
#include "kernels/contact/found.h"
#include "kernels/contact/rows.h"

/// A pair is a contact that may push if it gets nearer than so many ranges.
#define WEFT_CONTACT_MARGIN 1.25f

WEFT_KERNELS_BEGIN

/// What vertices have that may be of a pair; see fill_contacts.
typedef struct {
    WEFT_GLOBAL const float4* anchors;
    WEFT_GLOBAL const float4* goals;
    WEFT_GLOBAL const float* stiffness;
    WEFT_GLOBAL const float* between_sheets;
} contact_vertices;

/// Four vertices.
typedef struct {
    whole c0, c1, c2, c3;
} contact_corners;

WEFT_INLINE real least_of_corners(WEFT_GLOBAL const float* of_vertices, contact_corners corners) {
    const real k0 = gather(of_vertices, address(corners.c0));
    const real k1 = gather(of_vertices, address(corners.c1));
    const real k2 = gather(of_vertices, address(corners.c2));
    const real k3 = gather(of_vertices, address(corners.c3));
    return smaller(smaller(k0, k1), smaller(k2, k3));
}

WEFT_INLINE contact_pair load_pair(contact_vertices vertices, contact_corners corners) {
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const integer c0 = address(corners.c0);
    const integer c1 = address(corners.c1);
    const integer c2 = address(corners.c2);
    const integer c3 = address(corners.c3);
    const real4 g0 = gather4(vertices.goals, c0);
    const real4 g1 = gather4(vertices.goals, c1);
    const real4 g2 = gather4(vertices.goals, c2);
    const real4 g3 = gather4(vertices.goals, c3);
    contact_pair p;
    p.x0 = xyz(gather4(vertices.anchors, c0));
    p.x1 = xyz(gather4(vertices.anchors, c1));
    p.x2 = xyz(gather4(vertices.anchors, c2));
    p.x3 = xyz(gather4(vertices.anchors, c3));
    p.way0 = subtract(xyz(g0), p.x0);
    p.way1 = subtract(xyz(g1), p.x1);
    p.way2 = subtract(xyz(g2), p.x2);
    p.way3 = subtract(xyz(g3), p.x3);
    p.moves0 = g0.w > zero ? one : zero;
    p.moves1 = g1.w > zero ? one : zero;
    p.moves2 = g2.w > zero ? one : zero;
    p.moves3 = g3.w > zero ? one : zero;
    const real of_all = least_of_corners(vertices.stiffness, corners);
    const real between_sheets = least_of_corners(vertices.between_sheets, corners);
    p.least = between_sheets < zero ? of_all : between_sheets;
    return p;
}

WEFT_INLINE whole half_of(whole w) { return w >> splat_whole(1); }

/// Where entries of rows are written; see fill_contacts.
typedef struct {
    WEFT_GLOBAL float4* planes;
    WEFT_GLOBAL int* corner0;
    WEFT_GLOBAL int* corner1;
    WEFT_GLOBAL int* corner2;
    WEFT_GLOBAL int* corner3;
    WEFT_GLOBAL float4* normals;
    WEFT_GLOBAL float4* weights;
    WEFT_GLOBAL float4* measures;
} contact_columns;

/// The rows of one vertex while they are filled.
typedef struct {
    whole vertex;
    whole plane_start, plane_room;
    whole start, room;
    real farthest;           ///< from where planes are left out [m]
    whole planes, contacts;  ///< how many there are
    real least;              ///< room before a plane [m]
    real nearest;            ///< distance of a contact [m]
} contact_rows;

/// From how far away planes cannot hold back what stays in a ball of that radius [m].
WEFT_INLINE real out_of_reach(real radius, contact_settings settings) {
    const float start = WEFT_CONTACT_START_SLACK * settings.range;
    return radius + splat(start > settings.slack ? start : settings.slack);
}

/// A contact as one of its vertices has it.
typedef struct {
    real side;    ///< 1 where the vertex is of A, else -1
    real weight;  ///< its w
    real room;    ///< before its plane [m]
} contact_part;

WEFT_INLINE contact_part part_of(contact_found f, whole vertex, contact_corners c, int is_edges) {
    const real one = splat(1.0f);
    const mask is0 = vertex == c.c0;
    const mask is1 = vertex == c.c1;
    const mask is2 = vertex == c.c2;
    const real side1 = is_edges ? one : -one;
    contact_part part;
    part.side = is0 ? one : (is1 ? side1 : -one);
    const real4 w = f.push.weights;
    part.weight = is0 ? w.x : (is1 ? w.y : (is2 ? w.z : w.w));
    part.room = is0 ? f.room.x : (is1 ? f.room.y : (is2 ? f.room.z : f.room.w));
    return part;
}

WEFT_INLINE contact_rows add_plane(contact_rows row, mask is_apart, real3 away, real room,
                                   contact_columns out) {
    const mask holds_back = both(is_apart, room < row.farthest);
    const mask fits = both(holds_back, row.planes < row.plane_room);
    scatter4_where(fits, out.planes, address(row.plane_start + row.planes * WEFT_ROW_STRIDE),
                   with_w(away, room));
    row.planes = holds_back ? row.planes + splat_whole(1) : row.planes;
    row.least = is_apart ? smaller(row.least, room) : row.least;
    return row;
}

WEFT_INLINE contact_rows add_entry(contact_rows row, mask may_push, contact_found f,
                                   contact_corners c, contact_part part, float range,
                                   contact_columns out) {
    const mask fits = both(may_push, row.contacts < row.room);
    const integer entry = address(row.start + row.contacts * WEFT_ROW_STRIDE);
    scatter_whole_where(fits, out.corner0, entry, c.c0);
    scatter_whole_where(fits, out.corner1, entry, c.c1);
    scatter_whole_where(fits, out.corner2, entry, c.c2);
    scatter_whole_where(fits, out.corner3, entry, c.c3);
    const real side = part.side;
    const real own = side * part.weight;
    const real4 w = f.push.weights;
    real4 weights = {w.x * side, w.y * side, w.z * side, w.w * side};
    real4 measure = {own, own * f.push.spread, f.stiffness, splat(range)};
    scatter4_where(fits, out.normals, entry, with_w(scale(f.push.normal, side), f.push.ahead));
    scatter4_where(fits, out.weights, entry, weights);
    scatter4_where(fits, out.measures, entry, measure);
    row.contacts = may_push ? row.contacts + splat_whole(1) : row.contacts;
    return row;
}

/// Adds what the pair of these four vertices is to one of them.
/// is_on   for which items there is a pair at all
/// pushes  and one that may push
WEFT_INLINE contact_rows add_contact(contact_rows row, mask is_on, mask pushes, contact_corners c,
                                     int is_edges, contact_settings settings,
                                     contact_vertices vertices, contact_columns out) {
    const contact_found f = find_contact(load_pair(vertices, c), is_edges, settings);
    const contact_part part = part_of(f, row.vertex, c, is_edges);
    // Where they touch there is no direction between them.
    const mask is_apart = both(is_on, f.distance > splat(1e-12f));
    row = add_plane(row, is_apart, scale(f.normal, part.side), part.room, out);
    row.nearest = is_on ? smaller(row.nearest, f.distance) : row.nearest;
    const mask is_near =
        smaller(f.distance, f.push.ahead) < splat(WEFT_CONTACT_MARGIN * settings.range);
    const mask bears = part.side * part.weight * f.stiffness > splat(0.0f);
    const mask may_push = both(both(is_apart, pushes), both(is_near, bears));
    return add_entry(row, may_push, f, c, part, settings.range, out);
}

/// Of pairs with a triangle, in a column-major table; who uses it says c0.
WEFT_INLINE contact_corners with_triangle(WEFT_GLOBAL const int* triangles, whole t, int count) {
    contact_corners corners;
    corners.c0 = t;
    corners.c1 = gather_whole(triangles, address(t));
    corners.c2 = gather_whole(triangles, address(t + splat_whole(count)));
    corners.c3 = gather_whole(triangles, address(t + splat_whole(2 * count)));
    return corners;
}

/// Which patches have vertices that may have pairs, or had some in the substep before: rows of all
/// others are empty, and stay so.
/// around_begin, around  [items + 1], [entries] the patches that vertices of each patch belong to:
///                       all that their pairs are of
/// near_counts  [patches] how many patches are near to each
/// busy         [items] written: 1 where one of those around is near to another one, and 2 more where
///              one was in the substep before
WEFT_KERNEL(find_busy_patches, WEFT_GLOBAL const int* around_begin, WEFT_GLOBAL const int* around,
            WEFT_GLOBAL const int* near_counts, WEFT_GLOBAL int* busy, int instance) {
    const whole none = splat_whole(0);
    const whole one = splat_whole(1);
    const whole begin = load_whole(around_begin, i);
    const whole last = load_whole(around_begin, column(i, 1, 1)) - one;
    const int longest = largest_whole(last - begin) + 1;
    whole most = none;
    for (int k = 0; k < longest; ++k) {
        const integer entry = address(smaller_whole(begin + splat_whole(k), last));
        most = larger_whole(most, gather_whole(near_counts, address(gather_whole(around, entry))));
    }
    const whole before = load_whole(busy, i);
    const whole was = instance == 0 ? one : before - (before >> one) * splat_whole(2);
    store_whole(busy, i, (most > none ? one : none) + was * splat_whole(2));
}

/// Fills the rows of each vertex of the surface: from pairs with itself, with its triangles, with
/// its edges. In the order of the surface, so that vertices that are worked on together lie side by
/// side, and have about as many pairs.
/// anchors     [vertices] xyz: where pairs were found [m], w: how far the vertex may get [m]
/// goals       [vertices] xyz: where inertia, or the scene, leads them [m]; w = 1/mass [1/kg]
/// stiffness   [2 * vertices] column-major: what a contact's is measured by, and what one of sheets
///             is; < 0: of what is no sheet [N/m]
/// apexes      [items] the vertex of each
/// triangle_begin, triangle_list   [items + 1], [entries] which triangles it has
/// edge_begin, edge_list           likewise its edges
/// triangles   [3 * triangles] column-major: their vertices
/// edges       [2 * edges] likewise
/// patches     [items] the patch of each, ascending; busy: of patches, as find_busy_patches leaves it
/// vt_rows, vt_counts, vt_others   per item 2 * triangle + 1 where the pair pushes, else
///                                 2 * triangle (runtime/row_table.h)
/// tv_rows ... per triangle items; ee_rows ... per edge edges, as doubled
/// plane_rows, plane_counts, plane_needs, planes      written; see truncate.h
/// rows, counts, needs, corner0 to 3, normals, weights, measures  written; see rows.h
/// least       [vertices] written: the least room before its planes [m]; huge where there are no
///             pairs, 0 where it is held and there may be some
/// nearest     [vertices] written: the least distance of its pairs since instance 0 [m]
WEFT_NARROW_KERNEL(fill_contacts, WEFT_GLOBAL const float4* anchors,
                   WEFT_GLOBAL const float4* goals, WEFT_GLOBAL const float* stiffness,
                   WEFT_GLOBAL const int* apexes, WEFT_GLOBAL const int* triangle_begin,
                   WEFT_GLOBAL const int* triangle_list, WEFT_GLOBAL const int* edge_begin,
                   WEFT_GLOBAL const int* edge_list, WEFT_GLOBAL const int* triangles,
                   WEFT_GLOBAL const int* edges, WEFT_GLOBAL const int* patches,
                   WEFT_GLOBAL const int* busy, WEFT_GLOBAL const int* vt_rows,
                   WEFT_GLOBAL const int* vt_counts, WEFT_GLOBAL const int* vt_others,
                   WEFT_GLOBAL const int* tv_rows, WEFT_GLOBAL const int* tv_counts,
                   WEFT_GLOBAL const int* tv_others, WEFT_GLOBAL const int* ee_rows,
                   WEFT_GLOBAL const int* ee_counts, WEFT_GLOBAL const int* ee_others,
                   WEFT_GLOBAL const int* plane_rows, WEFT_GLOBAL int* plane_counts,
                   WEFT_GLOBAL int* plane_needs, WEFT_GLOBAL float4* planes,
                   WEFT_GLOBAL const int* rows, WEFT_GLOBAL int* counts, WEFT_GLOBAL int* needs,
                   WEFT_GLOBAL int* corner0, WEFT_GLOBAL int* corner1, WEFT_GLOBAL int* corner2,
                   WEFT_GLOBAL int* corner3, WEFT_GLOBAL float4* normals,
                   WEFT_GLOBAL float4* weights, WEFT_GLOBAL float4* measures,
                   WEFT_GLOBAL float* least, WEFT_GLOBAL float* nearest, int vertex_count,
                   int triangle_count, int edge_count, float range, float slack, float factor,
                   int instance) {
    if (!any_in_range(busy, patches[i.first], patches[i.first + i.count - 1])) return;
    const whole one = splat_whole(1);
    const whole none = splat_whole(0);
    const contact_settings settings = {range, slack, factor};
    const contact_vertices vertices = {anchors, goals, stiffness, stiffness + vertex_count};
    const contact_columns out = {planes,  corner0, corner1, corner2,
                                 corner3, normals, weights, measures};
    const whole vertex = load_whole(apexes, i);
    const integer own = address(vertex);
    const integer second = address(vertex + splat_whole(vertex_count));
    const whole may_have = gather_whole(busy, address(load_whole(patches, i)));
    const mask has_pairs = may_have - (may_have >> one) * splat_whole(2) > none;
    const real far = splat(WEFT_NO_PLANE);
    const real free = gather4(goals, own).w;
    const mask moves = both(has_pairs, free > splat(0.0f));
    const mask is_led = both(has_pairs, free <= splat(0.0f));
    contact_rows row;
    row.vertex = vertex;
    row.plane_start = gather_whole(plane_rows, own);
    row.plane_room = gather_whole(plane_rows, second);
    row.start = gather_whole(rows, own);
    row.room = gather_whole(rows, second);
    row.farthest = out_of_reach(gather4(anchors, own).w, settings);
    row.planes = none;
    row.contacts = none;
    row.least = is_led ? splat(0.0f) : far;
    row.nearest = far;

    const whole own_pairs = load_whole(vt_counts, i);
    const whole own_count = moves ? own_pairs : none;
    const whole own_start = load_whole(vt_rows, i);
    const int own_longest = largest_whole(own_count);
    for (int k = 0; k < own_longest; ++k) {
        const mask is_on = splat_whole(k) < own_count;
        const integer entry =
            address(is_on ? own_start + splat_whole(WEFT_ROW_STRIDE * k) : own_start);
        const whole code = is_on ? gather_whole(vt_others, entry) : none;
        const whole t = half_of(code);
        const mask pushes = code > t + t;
        contact_corners corners = with_triangle(triangles, t, triangle_count);
        corners.c0 = vertex;
        row = add_contact(row, is_on, pushes, corners, 0, settings, vertices, out);
    }

    const whole first_triangle = load_whole(triangle_begin, i);
    const whole end_triangle = load_whole(triangle_begin, column(i, 1, 1));
    const whole triangles_here = moves ? end_triangle - first_triangle : none;
    const int most_triangles = largest_whole(triangles_here);
    for (int n = 0; n < most_triangles; ++n) {
        const mask has = splat_whole(n) < triangles_here;
        const whole from = has ? first_triangle + splat_whole(n) : first_triangle;
        const whole t = gather_whole(triangle_list, address(from));
        const whole found = gather_whole(tv_counts, address(t));
        const whole count = has ? found : none;
        const int longest = largest_whole(count);
        if (longest > 0) {
            const whole t_start = gather_whole(tv_rows, address(t));
            contact_corners corners = with_triangle(triangles, t, triangle_count);
            for (int k = 0; k < longest; ++k) {
                const mask is_on = splat_whole(k) < count;
                const integer entry =
                    address(is_on ? t_start + splat_whole(WEFT_ROW_STRIDE * k) : t_start);
                const whole code = is_on ? gather_whole(tv_others, entry) : none;
                const whole other = half_of(code);
                const mask pushes = code > other + other;
                corners.c0 = gather_whole(apexes, address(other));
                row = add_contact(row, is_on, pushes, corners, 0, settings, vertices, out);
            }
        }
    }

    const whole first_edge = load_whole(edge_begin, i);
    const whole end_edge = load_whole(edge_begin, column(i, 1, 1));
    const whole edges_here = moves ? end_edge - first_edge : none;
    const int most_edges = largest_whole(edges_here);
    for (int n = 0; n < most_edges; ++n) {
        const mask has = splat_whole(n) < edges_here;
        const whole from = has ? first_edge + splat_whole(n) : first_edge;
        const whole e = gather_whole(edge_list, address(from));
        const whole found = gather_whole(ee_counts, address(e));
        const whole count = has ? found : none;
        const int longest = largest_whole(count);
        if (longest > 0) {
            const whole e_start = gather_whole(ee_rows, address(e));
            for (int k = 0; k < longest; ++k) {
                const mask is_on = splat_whole(k) < count;
                const integer entry =
                    address(is_on ? e_start + splat_whole(WEFT_ROW_STRIDE * k) : e_start);
                const whole code = is_on ? gather_whole(ee_others, entry) : none;
                const whole other = half_of(code);
                const mask pushes = code > other + other;
                const whole low = smaller_whole(e, other);
                const whole high = larger_whole(e, other);
                contact_corners corners;
                corners.c0 = gather_whole(edges, address(low));
                corners.c1 = gather_whole(edges, address(low + splat_whole(edge_count)));
                corners.c2 = gather_whole(edges, address(high));
                corners.c3 = gather_whole(edges, address(high + splat_whole(edge_count)));
                row = add_contact(row, is_on, pushes, corners, 1, settings, vertices, out);
            }
        }
    }

    const mask all = one > none;
    const int is_first = instance == 0;
    const whole wanted_planes = is_first ? none : gather_whole(plane_needs, own);
    const whole wanted = is_first ? none : gather_whole(needs, own);
    const real was_nearest = is_first ? far : gather(nearest, own);
    scatter_whole_where(all, plane_counts, own, smaller_whole(row.planes, row.plane_room));
    scatter_whole_where(all, counts, own, smaller_whole(row.contacts, row.room));
    scatter_whole_where(all, plane_needs, own, larger_whole(row.planes, wanted_planes));
    scatter_whole_where(all, needs, own, larger_whole(row.contacts, wanted));
    scatter_where(all, least, own, row.least);
    scatter_where(all, nearest, own, smaller(row.nearest, was_nearest));
}

WEFT_KERNELS_END

#endif
