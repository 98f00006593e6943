#ifndef WEFT_KERNELS_CONTACT_ROWS_H
#define WEFT_KERNELS_CONTACT_ROWS_H

// The contacts of a vertex, as they were found at the substep's begin and stay for the substep:
// normal n away from the other surface, weights w of the four vertices that meet (sum 0), and so a
// gap g(x) = n . sum w_j x_j that is linear in the positions. A contact has a row entry with each
// of its vertices, which all evaluate it themselves.
//
// All contacts of an iteration are seen at a snapshot s of the positions that all vertices share.
// By Cauchy-Schwarz (sum w_j d_j)^2 <= W sum |w_j| d_j^2, W = sum |w_j| of the vertices that move,
// so with c no less than E''
//
//   E(x) <= E(s) + sum_j [ E'(g(s)) w_j n . d_j + c/2 W |w_j| (n . d_j)^2 ],     d_j = x_j - s_j:
//
// each vertex has a gradient and a Hessian block of its own, and whatever the others do meanwhile,
// the energy falls. (The block c w_j^2 alone would be that of one vertex that moves while all
// others stand still: from a snapshot it diverges.)

#include "kernels/contact/energy.h"
#include "kernels/contact/truncation.h"
#include "kernels/descent/rows.h"
#include "kernels/lanes.h"

WEFT_KERNELS_BEGIN

/// One entry of a vertex' row, at a snapshot.
typedef struct {
    real3 normal;
    real own;        ///< |w| of the vertex
    real spread;     ///< W |w|
    real gap;        ///< [m]
    real ahead;      ///< the gap where inertia leads [m]
    real stiffness;  ///< [N/m]
    real range;      ///< [m]
} contact_entry;

/// Parameters as in gather_contacts.
WEFT_INLINE contact_entry
load_contact(WEFT_GLOBAL const float4* snapshot, WEFT_GLOBAL const int* corner0,
             WEFT_GLOBAL const int* corner1, WEFT_GLOBAL const int* corner2,
             WEFT_GLOBAL const int* corner3, WEFT_GLOBAL const float4* normals,
             WEFT_GLOBAL const float4* weights, WEFT_GLOBAL const float4* measures, integer entry) {
    const real4 n = gather4(normals, entry);
    const real4 w = gather4(weights, entry);
    const real4 m = gather4(measures, entry);
    const real3 s0 = xyz(gather4(snapshot, address(gather_whole(corner0, entry))));
    const real3 s1 = xyz(gather4(snapshot, address(gather_whole(corner1, entry))));
    const real3 s2 = xyz(gather4(snapshot, address(gather_whole(corner2, entry))));
    const real3 s3 = xyz(gather4(snapshot, address(gather_whole(corner3, entry))));
    contact_entry c;
    c.normal = xyz(n);
    c.ahead = n.w;
    c.gap = w.y * dot3(c.normal, subtract(s1, s0)) + w.z * dot3(c.normal, subtract(s2, s0)) +
            w.w * dot3(c.normal, subtract(s3, s0));
    c.own = m.x;
    c.spread = m.y;
    c.stiffness = m.z;
    c.range = m.w;
    return c;
}

/// Adds the contacts' part of each vertex' gradient and Hessian block.
/// positions   [vertices] xyz [m]
/// snapshots   [2 * vertices] xyz, of even and of odd iterations [m]
/// vertices    [items] the vertex of each item
/// rows        [2 * vertices] column-major: where the vertex' entries start, room for how many
/// counts      [vertices] how many there are
/// corner0     [entries] the vertices of the contact: corner0 to corner3
/// normals     [entries] xyz: n, away from the other surface; w: the gap where inertia leads [m]
/// weights     [entries] w_j, those of the vertex' side positive
/// measures    [entries] |w| of the vertex, W |w|, stiffness [N/m], range [m]
/// sums        [9 * items] see descent/rows.h
WEFT_KERNEL(gather_contacts, WEFT_GLOBAL const float4* positions,
            WEFT_GLOBAL const float4* snapshots, WEFT_GLOBAL const int* vertices,
            WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* counts,
            WEFT_GLOBAL const int* corner0, WEFT_GLOBAL const int* corner1,
            WEFT_GLOBAL const int* corner2, WEFT_GLOBAL const int* corner3,
            WEFT_GLOBAL const float4* normals, WEFT_GLOBAL const float4* weights,
            WEFT_GLOBAL const float4* measures, WEFT_GLOBAL float* sums, int item_count,
            int vertex_count, int iteration) {
    const integer vertex = load_index(vertices, i);
    const whole count = gather_whole(counts, vertex);
    const int longest = largest_whole(count);
    if (longest > 0) {
        WEFT_GLOBAL const float4* snapshot = snapshots + vertex_count * (iteration % 2);
        const whole start = gather_whole(rows, vertex);
        const real3 way = subtract(xyz(gather4(positions, vertex)), xyz(gather4(snapshot, vertex)));
        derivatives s = load_derivatives(sums, i, item_count);
        for (int k = 0; k < longest; ++k) {
            const mask on = splat_whole(k) < count;
            const integer entry =
                address(on ? start + splat_whole(WEFT_CONTACT_STRIDE * k) : start);
            const contact_entry c = load_contact(snapshot, corner0, corner1, corner2, corner3,
                                                 normals, weights, measures, entry);
            const mask is_near = smaller(c.gap, c.ahead) < c.range;
            const real slope = contact_slope(c.gap, c.range, c.stiffness);
            const real bound = contact_majorant(c.gap, c.ahead, c.range, c.stiffness);
            const real block = both(on, is_near) ? bound * c.spread : splat(0.0f);
            const real push = both(on, is_near) ? slope * c.own : splat(0.0f);
            s.gradient = add_scaled(s.gradient, c.normal, push + block * dot3(c.normal, way));
            s.hessian = add_sym(s.hessian, outer_sym(c.normal, block));
        }
        store_derivatives(sums, i, item_count, s);
    }
}

/// Lets all see the positions in the next iteration.
/// positions  [vertices] xyz [m], w = 1/mass [1/kg]
/// snapshots  [2 * vertices] written: of odd iterations in the second half
/// next       the iteration that is to see it
WEFT_KERNEL(take_snapshot, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL float4* snapshots,
            int vertex_count, int iteration, int ahead) {
    store4(snapshots, column(i, vertex_count, (iteration + ahead) % 2), load4(positions, i));
}

WEFT_KERNELS_END

#endif
