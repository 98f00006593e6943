#ifndef WEFT_KERNELS_CONTACT_RESTING_H
#define WEFT_KERNELS_CONTACT_RESTING_H

// Bodies on convex obstacles, as the rounds of bodies.h see them. To vertices, obstacles are hard:
// each iteration pushes them out (obstacles/contact.h). A stiff solid that a substep leads into the
// ground by 1 mm has its lowest vertices pushed up by that, and the few iterations that follow can
// neither lift all of it nor take back the strain: a block of 1e8 Pa that fell by 5 mm had a
// thousand times the energy of its fall. So such solids are led as wholes out of what they are on,
// before the first iteration and behind the last one, and in rounds obstacles are contacts like any
// other. An entry of a body's row is a vertex that is near one. It presses by
//
//   max(0, r - k gap)
//
// where r is what the obstacle bears there now: of a vertex that stays where it is, what elements
// press it by and what its inertia lacks,
//
//   r = n . (g + m/h^2 (x - x~))
//
// with the gradient g of the elements' energy. k is about how hard elements resist there, so that
// is what there will be when the body has moved. A corner that has met the ground stops, and only g
// says that the body goes on and crushes it: a block of 1e7 Pa that xpbd dropped by 10 cm stored 20
// times the energy of its fall (docs/measurements.md, "Solids that fall on their corners"). By
// pushes that have led x~ along, a part of r is known (bodies/reactions.h), none of it before the
// first iteration; the body lacks that no more, so what counts is how much more or less it gets. Of
// cloth that part is all.
//
// An entry rubs solids as contacts do: by the slip since the vertex came to lie there (sticking.h),
// and as hard as what bears the body says (bearings.h).
//
// Cloth in contact lies on obstacles likewise. Where a sheet comes to lie on another one, a round
// that knows of their contact alone leads the lower one into what bears it by as much as the upper
// one out, and iterations push it back into the upper one: two sheets that fell on a table stored
// four hundred times what they had (docs/measurements.md, "Sheets that fall on obstacles"). How
// obstacles rub single vertices of cloth is known from iterations, and nothing is added to that.

#include "kernels/bodies/runs.h"
#include "kernels/choice.h"
#include "kernels/contact/codes.h"
#include "kernels/contact/rows.h"
#include "kernels/obstacles/seen.h"

WEFT_KERNELS_BEGIN

/// Behind the point of an entry, instead of the coefficient of friction: this is none of these.
#define WEFT_RESTS_NOT -1.0f

/// What a vertex may be off an obstacle that it touches, as a part of what is near.
#define WEFT_RESTING_TOUCH 0.01f

/// How hard an obstacle presses [N].
/// known  as above [N]
WEFT_INLINE real press_of_resting(contact_entry c, real known) {
    return larger(known - c.stiffness * c.gap, splat(0.0f));
}

/// Adds what it does to the body besides what is known, where it is on.
WEFT_INLINE derivatives add_resting(derivatives s, contact_entry c, mask on, real known) {
    const real zero = splat(0.0f);
    const real press = on ? press_of_resting(c, known) : zero;
    const real block = press > zero ? c.stiffness : zero;
    s.gradient = add_scaled(s.gradient, c.normal, on ? known - press : zero);
    s.hessian = add_sym(s.hessian, outer_sym(c.normal, block));
    return s;
}

/// x~ as rounds see it: solids are led by what obstacles bear across their surfaces, and by no
/// more.
/// targets, starts  [vertices] xyz: x~ with all pushes, and before them [m]; w of the first: the
///                  grip (obstacles/grip.h) [m]
/// pressing         [vertices] see obstacles/contact.h
/// solid            [vertices] 1, or 0: its x~ is as it was
/// seen_targets, seen_starts  [vertices] written, as targets and starts; of solids the same
WEFT_KERNEL(see_targets, WEFT_GLOBAL const float4* targets, WEFT_GLOBAL const float4* starts,
            WEFT_GLOBAL const float4* pressing, WEFT_GLOBAL const float* solid,
            WEFT_GLOBAL float4* seen_targets, WEFT_GLOBAL float4* seen_starts) {
    const real4 target = load4(targets, i);
    const real4 start = load4(starts, i);
    const mask is_solid = load(solid, i) > splat(0.0f);
    const real3 push = subtract(xyz(target), xyz(start));
    const real3 led = add(xyz(start), pushed_along(push, xyz(load4(pressing, i))));
    const real4 own = with_w(led, splat(0.0f));
    store4(seen_targets, i, target);
    store4(seen_starts, i, start);
    store4_where(is_solid, seen_targets, i, own);
    store4_where(is_solid, seen_starts, i, own);
}

/// Where a vertex, or a triangle around it, comes nearest to an obstacle.
typedef struct {
    real3 normal;  ///< of length 1, outwards
    real3 point;   ///< [m]
    real gap;      ///< [m]
} resting_place;

/// meetings  of this obstacle, as find_obstacle_meetings leaves them (obstacles/narrow.h); read
///           where has_meetings and of solids
WEFT_INLINE resting_place place_on(WEFT_GLOBAL const float4* o, real3 before, real3 x,
                                   WEFT_GLOBAL const float4* meetings, int has_meetings,
                                   real is_solid, integer vertex, int vertex_count) {
    const nearness near = seen_from(o, before, x);
    resting_place place = {apply_back(o, near.normal), x, near.distance - splat(o[7].x)};
    if (!has_meetings) return place;
    const real4 met = gather4(meetings, vertex);
    const real3 point = xyz(gather4(meetings + vertex_count, vertex));
    const mask is_nearer = both(is_solid > splat(0.0f), met.w < place.gap);
    place.normal = either(is_nearer, xyz(met), place.normal);
    place.point = either(is_nearer, point, place.point);
    place.gap = is_nearer ? met.w : place.gap;
    return place;
}

/// Adds an entry for each vertex of a column's body that is near an obstacle, behind the contacts
/// of the column (pushes.h). Where a triangle of a solid lies on a narrow obstacle, each of its
/// corners has one, at the place where the triangle does, with what the corner bears.
/// positions    [vertices] xyz, w = 1/mass [1/kg]
/// previous     [vertices] xyz at the substep's start [m]
/// seen_targets [vertices] as see_targets leaves them; starts: as there
/// kept         [vertices] xyz: the slips that the substep began with [m]
/// obstacles    [substeps * obstacle_count * WEFT_OBSTACLE_ROWS], see obstacles/contact.h
/// borne        [vertices] 1: of a body that lies on obstacles as a whole; else 0
/// solid        [vertices] as in see_targets: what obstacles rub
/// hardness     [vertices] k [N/m]
/// meetings     [2 * obstacle_count * vertex_count] as find_obstacle_meetings leaves them; not read
///              without has_meetings
/// gradients    [3 * vertex_count] column-major: g [N]; not read without has_gradients
/// push_rows to presses  as collect_pushes leaves them; here of other_points w: what is known [N]
/// reach        [m] what is farther away has no entry, unless it may come so far: twice as far as it
///              has gone, where its body is turned
/// inverse_h2, instance  as in collect_pushes
WEFT_NARROW_KERNEL(collect_resting, WEFT_GLOBAL const float4* positions,
                   WEFT_GLOBAL const float4* previous, WEFT_GLOBAL const float4* seen_targets,
                   WEFT_GLOBAL const float4* starts, WEFT_GLOBAL const float4* kept,
                   WEFT_GLOBAL const float4* obstacles, WEFT_GLOBAL const float* borne,
                   WEFT_GLOBAL const float* solid, WEFT_GLOBAL const float* hardness,
                   WEFT_GLOBAL const float4* meetings, WEFT_GLOBAL const float* gradients,
                   WEFT_GLOBAL const int* members, WEFT_GLOBAL const float* shares,
                   WEFT_GLOBAL const int* column_rows, WEFT_GLOBAL const int* push_rows,
                   WEFT_GLOBAL int* push_counts, WEFT_GLOBAL int* push_needs,
                   WEFT_GLOBAL int* codes, WEFT_GLOBAL float4* sides, WEFT_GLOBAL float4* slips,
                   WEFT_GLOBAL float4* forces, WEFT_GLOBAL float4* points,
                   WEFT_GLOBAL float4* other_points, WEFT_GLOBAL float* presses, int column_count,
                   int vertex_count, int body_count, int obstacle_count, float reach,
                   float inverse_h2, int has_meetings, int has_gradients, int instance) {
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const whole push_start = load_whole(push_rows, i);
    const whole room = load_whole(push_rows, column(i, column_count, 1));
    whole found = load_whole(push_counts, i);
    const int length = column_rows[2 * i.first + 1];
    for (int k = 0; k < length; ++k) {
        const item member = {column_rows[2 * i.first] + WEFT_RUN_COLUMNS * k, i.count};
        const integer vertex = load_index(members, member);
        const real4 x = gather4(positions, vertex);
        const real counts = load(shares, member) * gather(borne, vertex) * x.w;
        if (!any_item(counts > zero)) continue;
        const real3 before = xyz(gather4(previous, vertex));
        const real3 earlier = xyz(gather4(kept, vertex));
        const real way_gone = length3(subtract(xyz(x), before));
        const real near_enough = splat(reach) + splat(2.0f) * way_gone;
        const real hard = gather(hardness, vertex);
        const real is_solid = gather(solid, vertex);
        real3 gradient = make3(zero, zero, zero);
        if (has_gradients) gradient = gather_gradient(gradients, vertex, vertex_count);
        const real inertia = counts > zero ? splat(inverse_h2) / x.w : zero;
        const real3 target = xyz(gather4(seen_targets, vertex));
        real3 pull = add_scaled(gradient, subtract(target, xyz(x)), -inertia);
        real3 led = subtract(target, xyz(gather4(starts, vertex)));
        // Of several, those bear it that it touches, or the nearest one, which is found first.
        real least = splat(1e30f);
        const int first_place = obstacle_count > 1 ? -obstacle_count : 0;
        for (int place = first_place; place < obstacle_count; ++place) {
            const int number = place < 0 ? place + obstacle_count : place;
            WEFT_GLOBAL const float4* o =
                obstacles + WEFT_OBSTACLE_ROWS * (instance * obstacle_count + number);
            const resting_place at = place_on(
                o, before, xyz(x), meetings + (has_meetings ? 2 * number * vertex_count : 0),
                has_meetings, is_solid, vertex, vertex_count);
            const real gap = at.gap;
            if (place < 0) {
                least = smaller(least, gap);
                continue;
            }
            const mask is_near = both(counts > zero, gap < near_enough);
            if (!any_item(is_near)) continue;
            const mask bears =
                both(is_near, gap < larger(least, zero) + splat(WEFT_RESTING_TOUCH * reach));
            // Of several that push as one, the first ones push.
            const real3 normal = at.normal;
            const real way = bears ? larger(dot3(led, normal), zero) : zero;
            led = add_scaled(led, normal, -way);
            const real known = way * inertia;
            const real more = bears ? dot3(pull, normal) * is_solid : zero;
            pull = add_scaled(pull, normal, -more);
            const real pressed = more / (is_near ? hard : one);
            const real3 slid = slid_along(o, xyz(x), before, normal);
            const real3 slip = add(slid, along_surface(earlier, normal));
            const mask fits = both(is_near, found < room);
            const integer entry = address(push_start + found * WEFT_ROW_STRIDE);
            const real4 force = {one, one, hard, one};
            const real friction = splat(o[7].y) * is_solid;
            scatter_whole_where(fits, codes, entry, code_of_body(splat_whole(body_count)));
            scatter4_where(fits, sides, entry, with_w(normal, gap - pressed));
            scatter4_where(fits, slips, entry, with_w(slip, one));
            scatter4_where(fits, forces, entry, force);
            scatter4_where(fits, points, entry, with_w(at.point, friction));
            scatter4_where(fits, other_points, entry, with_w(at.point, known));
            scatter_where(fits, presses, entry, known);
            found = is_near ? found + splat_whole(1) : found;
        }
    }
    store_whole(push_counts, i, smaller_whole(found, room));
    store_whole(push_needs, i, larger_whole(found, load_whole(push_needs, i)));
}

/// What stays of the slips of vertices along the obstacles that they are near, where a substep
/// ends.
/// slips  [vertices] from what there was to what there is, xyz [m]
/// creep  e [m] > 0: what is beyond has slid for good
/// others as in collect_resting
WEFT_KERNEL(keep_resting_slips, WEFT_GLOBAL const float4* positions,
            WEFT_GLOBAL const float4* previous, WEFT_GLOBAL const float4* obstacles,
            WEFT_GLOBAL float4* slips, int obstacle_count, float reach, float creep, int substep) {
    const real zero = splat(0.0f);
    const real3 x = xyz(load4(positions, i));
    const real3 before = xyz(load4(previous, i));
    const real3 kept = xyz(load4(slips, i));
    real nearest = splat(reach);
    real3 slip = make3(zero, zero, zero);
    for (int number = 0; number < obstacle_count; ++number) {
        WEFT_GLOBAL const float4* o =
            obstacles + WEFT_OBSTACLE_ROWS * (substep * obstacle_count + number);
        const nearness near = seen_from(o, before, x);
        const real gap = near.distance - splat(o[7].x);
        const real3 normal = apply_back(o, near.normal);
        const real3 gone = add(along_surface(kept, normal), slid_along(o, x, before, normal));
        const real stays = splat(creep) / larger(length3(gone), splat(creep));
        const mask is_nearest = gap < nearest;
        slip.x = is_nearest ? gone.x * stays : slip.x;
        slip.y = is_nearest ? gone.y * stays : slip.y;
        slip.z = is_nearest ? gone.z * stays : slip.z;
        nearest = smaller(nearest, gap);
    }
    store4(slips, i, with_w(slip, zero));
}

WEFT_KERNELS_END

#endif
