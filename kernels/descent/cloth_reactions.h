#ifndef WEFT_KERNELS_DESCENT_CLOTH_REACTIONS_H
#define WEFT_KERNELS_DESCENT_CLOTH_REACTIONS_H

// What obstacles bear of cloth, solved with each vertex. A push leads x~ along
// (obstacles/contact.h) and so counts as a force against inertia alone. But elements hold a vertex
// some fifty times as hard, so pushes add up to what these press and pull with by a fiftieth in
// each iteration, and friction takes back ways as short as that, whatever pulls: cloth that should
// slide over a rail stuck to it, and sheets that a table's edge stretched got joules from nowhere.
//
// So before a vertex is solved that has been pushed in the substep, what the obstacle bears of it
// is found from its own system, A dx = r + R with r of all but the obstacle, by the laws of
// Signorini and Coulomb:
//
//   R_n >= 0 and no deeper into it; |R_t| <= mu R_n; no slip where that is less, else against it
//
// (the local problem of nonsmooth contact dynamics: Jourdan, Alart and Jean 1998). x~ is led by
// what R is against inertia, instead of all pushes before. All other vertices stand still
// meanwhile, as in the step itself; where A is isotropic this is exact. What touches other cloth
// has its pushes alone (docs/measurements.md, "What obstacles bear").

#include "kernels/descent/vertex_system.h"
#include "kernels/lanes.h"
#include "kernels/obstacles/grip.h"
#include "kernels/obstacles/nearest.h"

WEFT_KERNELS_BEGIN

/// What an obstacle bears of a vertex that slides.
typedef struct {
    real3 force;  ///< [N]
    real3 moved;  ///< what that moves it by [m]
} sliding_reaction;

/// As much along a line of the cone of friction as keeps the vertex out.
/// factors  of A
/// along    the part of the line along the surface, of any length
/// inwards  how far into the obstacle the vertex would go without it [m]
/// own      n . A^-1 n [m/N]: where friction pushes it inwards, too, as much as it does out, nothing
///          would keep it out
WEFT_INLINE sliding_reaction reaction_along(sym3_factors factors, surface_contact c, real3 along,
                                            real inwards, real own) {
    const real3 line = add_scaled(c.normal, along, c.friction / divisor(length3(along)));
    const real3 yields = solve_factored(factors, line);
    const real press = inwards / divisor(larger(dot3(c.normal, yields), own * splat(0.1f)));
    const sliding_reaction s = {scale(line, press), scale(yields, press)};
    return s;
}

/// R [N]
WEFT_INLINE real3 borne_of_vertex(sym3 A, real3 r, surface_contact c) {
    const real zero = splat(0.0f);
    const sym3_factors factors = factor_sym(A);
    const real3 alone = solve_factored(factors, r);
    const real inwards = -c.gap - dot3(c.normal, alone);
    // Where it sticks, it is held back to where on the surface it was.
    const real3 back = add_scaled(scale(c.slip, splat(-1.0f)), c.normal, -c.gap);
    const real3 holds = subtract(multiply_sym(A, back), r);
    const real3 holds_along = along_surface(holds, c.normal);
    const mask sticks = length3(holds_along) <= c.friction * dot3(c.normal, holds);
    // Where it slides, friction goes against the slip that it leaves. Nearly where it would stick
    // that is along what would hold it, and far from there along the slip, whatever A is: by one
    // step of projection (De Saxce and Feng 1998) both are found.
    const real own = dot3(c.normal, solve_factored(factors, c.normal));
    const sliding_reaction first = reaction_along(factors, c, holds_along, inwards, own);
    const real3 slip = add(c.slip, along_surface(add(alone, first.moved), c.normal));
    const real3 against =
        add_scaled(along_surface(first.force, c.normal), slip, trace_sym(A) * splat(-0.3f));
    const real3 slides = reaction_along(factors, c, against, inwards, own).force;
    const real pressed = inwards > zero ? splat(1.0f) : zero;
    return scale(either(sticks, holds, slides), pressed);
}

/// The nearest of the planes that triangles have given a vertex [m].
/// planes  [narrow_count * vertex_count] column-major, see obstacles/narrow.h
WEFT_INLINE real nearest_plane(WEFT_GLOBAL const float4* planes, int narrow_count, int vertex_count,
                               integer vertex, real3 x) {
    real nearest = splat(3e38f);
    for (int narrow = 0; narrow < narrow_count; ++narrow) {
        const real4 plane = gather4(planes + narrow * vertex_count, vertex);
        nearest = smaller(nearest, dot3(xyz(plane), x) - plane.w);
    }
    return nearest;
}

/// How many contacts of cloth with cloth a vertex has, where that counts.
/// cloth, rows, counts, corner0 to corner3  as below
WEFT_INLINE real touching_cloth(WEFT_GLOBAL const float* cloth, WEFT_GLOBAL const int* rows,
                                WEFT_GLOBAL const int* counts, WEFT_GLOBAL const int* corner0,
                                WEFT_GLOBAL const int* corner1, WEFT_GLOBAL const int* corner2,
                                WEFT_GLOBAL const int* corner3, integer vertex, mask that_counts) {
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const whole start = gather_whole(rows, vertex);
    const whole none = splat_whole(0);
    const whole count = that_counts ? gather_whole(counts, vertex) : none;
    const int longest = largest_whole(count);
    real found = zero;
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
        const real all = gather(cloth, address(gather_whole(corner0, entry))) *
                         gather(cloth, address(gather_whole(corner1, entry))) *
                         gather(cloth, address(gather_whole(corner2, entry))) *
                         gather(cloth, address(gather_whole(corner3, entry)));
        found = found + (both(on, all > zero) ? one : zero);
    }
    return found;
}

/// Leads x~ of cloth that obstacles have pushed by what they bear of it, before it is solved.
/// positions   [vertices] xyz [m], w = 1/mass [1/kg]
/// previous    [vertices] xyz at the substep's start [m]
/// starts      [vertices] xyz: x~ before all pushes [m]
/// targets     [vertices] xyz: x~ [m], w: the grip (obstacles/grip.h) [m]; written
/// cloth       [vertices] 1: this counts for it; else 0
/// vertices    [items] the vertex of each item
/// sums        [9 * items] g and H of all elements and contacts; see descent/rows.h
/// obstacles   [substeps * obstacle_count * WEFT_OBSTACLE_ROWS], see obstacles/contact.h. What is on
///             two of them, behind a plane, or in contact with cloth keeps what pushes have led
///             x~ by
/// planes      as in nearest_plane
/// rows, counts, corner0 to corner3  as in gather_contacts (contact/rows.h); not read unless
///             has_contacts
/// inverse_h2  1 / h^2 [1/s^2], h the substep
WEFT_KERNEL(lead_cloth, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float4* previous,
            WEFT_GLOBAL const float4* starts, WEFT_GLOBAL float4* targets,
            WEFT_GLOBAL const float* cloth, WEFT_GLOBAL const int* vertices,
            WEFT_GLOBAL const float* sums, WEFT_GLOBAL const float4* obstacles,
            WEFT_GLOBAL const float4* planes, WEFT_GLOBAL const int* rows,
            WEFT_GLOBAL const int* counts, WEFT_GLOBAL const int* corner0,
            WEFT_GLOBAL const int* corner1, WEFT_GLOBAL const int* corner2,
            WEFT_GLOBAL const int* corner3, int item_count, float inverse_h2, int has_contacts,
            int narrow_count, int vertex_count, int obstacle_count, int substep) {
    const real zero = splat(0.0f);
    const integer vertex = load_index(vertices, i);
    const real4 target = gather4(targets, vertex);
    const real4 x = gather4(positions, vertex);
    mask was_pushed = both(target.w * gather(cloth, vertex) > zero, x.w > zero);
    if (has_contacts) {
        const real touching = touching_cloth(cloth, rows, counts, corner0, corner1, corner2,
                                             corner3, vertex, was_pushed);
        was_pushed = both(was_pushed, touching == zero);
    }
    if (!any_item(was_pushed)) return;

    const surface_contact c =
        nearest_surface(obstacles + WEFT_OBSTACLE_ROWS * (substep * obstacle_count), obstacle_count,
                        xyz(gather4(previous, vertex)), xyz(x));
    const real a_few_roundings = splat(2e-6f) * length3(xyz(x));
    const real plane = nearest_plane(planes, narrow_count, vertex_count, vertex, xyz(x));
    const mask is_borne = both(was_pushed, smaller(c.beside, plane) > a_few_roundings);
    const real inertia = splat(inverse_h2) / (is_borne ? x.w : splat(1.0f));
    const derivatives s = load_derivatives(sums, i, item_count);
    const real3 start = xyz(gather4(starts, vertex));
    const real3 r = subtract(scale(subtract(start, xyz(x)), inertia), s.gradient);
    const real3 borne = borne_of_vertex(add_diagonal(s.hessian, inertia), r, c);
    const real3 led = scale(borne, splat(1.0f) / inertia);
    const real left = c.friction * dot3(led, c.normal) - length3(along_surface(led, c.normal));
    scatter4_where(is_borne, targets, vertex,
                   with_w(add(start, led), larger(left, splat(WEFT_NO_GRIP))));
}

WEFT_KERNELS_END

#endif
