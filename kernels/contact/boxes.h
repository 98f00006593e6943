#ifndef WEFT_KERNELS_CONTACT_BOXES_H
#define WEFT_KERNELS_CONTACT_BOXES_H

// Boxes around all places that vertices may reach in a substep, half of the thickness beyond: of
// patches of a surface (simulation/contact/surface.h), of groups of them, and of strips. Unions
// are exact, so what is in a box is in all boxes above it.
//
// Patches of strips that run aslant lie aslant in their boxes, and beside each other where boxes
// overlap. So they have bounds along sums and differences of coordinates as well (18-DOP: Klosowski
// et al. 1998).

#include "kernels/columns.h"
#include "kernels/lanes.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

typedef struct {
    real3 low, high;
} real_box;

WEFT_INLINE real_box empty_box(void) {
    const real far = splat(3e38f);
    real_box box;
    box.low = make3(far, far, far);
    box.high = make3(-far, -far, -far);
    return box;
}

WEFT_INLINE real_box box_around(real3 x, real q) {
    real_box box;
    box.low = make3(x.x - q, x.y - q, x.z - q);
    box.high = make3(x.x + q, x.y + q, x.z + q);
    return box;
}

/// The ball that a vertex stays in, and the margin. anchor: xyz, w = the ball's radius
WEFT_INLINE real_box box_of(real4 anchor, real margin) {
    return box_around(xyz(anchor), anchor.w + margin);
}

// By so much a sum or a difference of two coordinates changes at most, per distance.
#define WEFT_SLANT 1.41421356f

WEFT_INLINE real3 sums_of(real4 p) { return make3(p.x + p.y, p.x + p.z, p.y + p.z); }
WEFT_INLINE real3 differences_of(real4 p) { return make3(p.x - p.y, p.x - p.z, p.y - p.z); }

WEFT_INLINE real_box united(real_box a, real_box b) {
    real_box box;
    box.low =
        make3(smaller(b.low.x, a.low.x), smaller(b.low.y, a.low.y), smaller(b.low.z, a.low.z));
    box.high =
        make3(larger(b.high.x, a.high.x), larger(b.high.y, a.high.y), larger(b.high.z, a.high.z));
    return box;
}

/// Brings the anchors into the order of the surface.
/// anchors    [model vertices] xyz [m], w = how far the vertex may get from there [m]
/// vertices   [items] the model's
/// points     [items] written
WEFT_KERNEL(place_points, WEFT_GLOBAL const float4* anchors, WEFT_GLOBAL const int* vertices,
            WEFT_GLOBAL float4* points) {
    store4(points, i, gather4(anchors, load_index(vertices, i)));
}

/// Boxes of patches.
/// hull_begin  [items + 1] where the vertices of each begin in `hulls`; none has none
/// hulls       model vertices
/// low, high   [items] written; w of high: the largest reach of its vertices [m]
/// slant_low, slant_high   [2 * items] column-major, written: of the sums x + y, x + z, y + z, and
///             of the differences likewise [m]
/// margin      [m]
WEFT_NARROW_KERNEL(enclose_patches, WEFT_GLOBAL const float4* anchors,
                   WEFT_GLOBAL const int* hull_begin, WEFT_GLOBAL const int* hulls,
                   WEFT_GLOBAL float4* low, WEFT_GLOBAL float4* high, WEFT_GLOBAL float4* slant_low,
                   WEFT_GLOBAL float4* slant_high, float margin, int item_count) {
    const whole begin = load_whole(hull_begin, i);
    const whole last = load_whole(hull_begin, column(i, 1, 1)) - splat_whole(1);
    const int longest = largest_whole(last - begin) + 1;
    const item second = column(i, item_count, 1);
    const real zero = splat(0.0f);
    real_box box = empty_box();
    real_box sums = box;
    real_box differences = box;
    real reach = zero;
    for (int k = 0; k < longest; ++k) {
        const integer entry = address(smaller_whole(begin + splat_whole(k), last));
        const real4 x = gather4(anchors, address(gather_whole(hulls, entry)));
        const real q = splat(WEFT_SLANT) * (x.w + splat(margin));
        box = united(box, box_of(x, splat(margin)));
        sums = united(sums, box_around(sums_of(x), q));
        differences = united(differences, box_around(differences_of(x), q));
        reach = larger(x.w, reach);
    }
    store4(low, i, with_w(box.low, zero));
    store4(high, i, with_w(box.high, reach));
    store4(slant_low, i, with_w(sums.low, zero));
    store4(slant_high, i, with_w(sums.high, zero));
    store4(slant_low, second, with_w(differences.low, zero));
    store4(slant_high, second, with_w(differences.high, zero));
}

/// What items that have fewer than others read beside them, for nothing: an entry of their own, as
/// nobody else may be writing there meanwhile.
WEFT_INLINE whole first_of(whole begin, whole count) {
    return count > splat_whole(0) ? begin : splat_whole(0);
}

/// Boxes around boxes.
/// child_begin          [items + 1] where the children of each begin
/// child_low, child_high  boxes
/// low, high            [items] written
WEFT_NARROW_KERNEL(enclose_boxes, WEFT_GLOBAL const int* child_begin,
                   WEFT_GLOBAL const float4* child_low, WEFT_GLOBAL const float4* child_high,
                   WEFT_GLOBAL float4* low, WEFT_GLOBAL float4* high) {
    const whole begin = load_whole(child_begin, i);
    const whole count = load_whole(child_begin, column(i, 1, 1)) - begin;
    const whole own = first_of(begin, count);
    const int longest = largest_whole(count);
    real_box box = empty_box();
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer child = address(on ? begin + splat_whole(k) : own);
        real_box of_child;
        of_child.low = xyz(gather4(child_low, child));
        of_child.high = xyz(gather4(child_high, child));
        const real_box both_boxes = united(box, of_child);
        box.low.x = on ? both_boxes.low.x : box.low.x;
        box.low.y = on ? both_boxes.low.y : box.low.y;
        box.low.z = on ? both_boxes.low.z : box.low.z;
        box.high.x = on ? both_boxes.high.x : box.high.x;
        box.high.y = on ? both_boxes.high.y : box.high.y;
        box.high.z = on ? both_boxes.high.z : box.high.z;
    }
    store4(low, i, with_w(box.low, splat(0.0f)));
    store4(high, i, with_w(box.high, splat(0.0f)));
}

/// A corner of a triangle each, in column-major tables.
WEFT_INLINE real4 gather_corner(WEFT_GLOBAL const float4* anchors, WEFT_GLOBAL const int* corners,
                                whole entry) {
    return gather4(anchors, address(gather_whole(corners, address(entry))));
}

/// A corner's way by inertia, or as the scene leads it.
WEFT_INLINE real3 gather_way(WEFT_GLOBAL const float4* goals, WEFT_GLOBAL const int* corners,
                             whole entry, real4 anchor) {
    return subtract(xyz(gather_corner(goals, corners, entry)), xyz(anchor));
}

WEFT_INLINE real square_of(real3 a) { return dot3(a, a); }

// Shares of the largest way that counts as quiet (tilt_patches): two vertices may come nearer to
// each other by twice that. Inertia may lead vertices of one patch so far from their mean,
#define WEFT_SPREAD_SHARE 0.125f
// means of patches beside each other so far apart,
#define WEFT_DRIFT_SHARE 0.25f
// and a vertex may go so far from where inertia led it. 2 * 0.125 + 0.25 + 2 * 0.75 = 2.
#define WEFT_LOOSE_SHARE 0.75f

/// Which way patches face, and whether each is flat and quiet: its normals lie within 30 degrees of
/// their mean, and no vertex gets so far that a triangle could turn over; or all are led so alike
/// by their inertia that none does, as long as they follow it. (quiet.h looks whether they did.)
/// goals       [vertices] xyz: where inertia, or the scene, leads [m]
/// foresees    [1] 0: nothing counts but how far vertices may get
/// face_begin  [items + 1] where the faces of each begin (Surface::faces)
/// corners     [3 * face_count] column-major: model vertices
/// high        [items] as enclose_patches leaves it
/// quiet       [items] how far vertices may get [m]
/// tilts       [items] written: where it is flat and quiet xyz = the mean of the normals, of length
///             1, and w = 1, or 2 where it is quiet by inertia alone; else 0
/// drifts      [items] written: xyz: the mean of the ways [m], w: how far apart ways of patches
///             beside it may be [m]
WEFT_NARROW_KERNEL(tilt_patches, WEFT_GLOBAL const float4* anchors, WEFT_GLOBAL const float4* goals,
                   WEFT_GLOBAL const int* foresees, WEFT_GLOBAL const int* face_begin,
                   WEFT_GLOBAL const int* corners, WEFT_GLOBAL const float4* high,
                   WEFT_GLOBAL const float* quiet, WEFT_GLOBAL float4* tilts,
                   WEFT_GLOBAL float4* drifts, int face_count) {
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const whole begin = load_whole(face_begin, i);
    const whole count = load_whole(face_begin, column(i, 1, 1)) - begin;
    const whole own = first_of(begin, count);
    const real limit = load(quiet, i);
    // What is not quiet by itself need not be looked at, if nothing is foreseen.
    const real apart = splat(WEFT_SPREAD_SHARE) * limit;
    const mask may_be = load4(high, i).w < limit;
    const int do_foresee = foresees[0];
    int longest = 0;
    if (do_foresee != 0 || any_item(may_be)) longest = largest_whole(count);
    real3 mean = make3(zero, zero, zero);
    real3 drift = make3(zero, zero, zero);
    real ways = zero;
    real flat = may_be ? one : zero;
    real alike = do_foresee != 0 ? one : zero;
    real upright = one;
    for (int pass = 0; pass < 2; ++pass) {
        for (int k = 0; k < longest; ++k) {
            const mask on = splat_whole(k) < count;
            const whole entry = on ? begin + splat_whole(k) : own;
            const real4 a = gather_corner(anchors, corners, entry);
            const real4 b = gather_corner(anchors, corners, entry + splat_whole(face_count));
            const real4 c = gather_corner(anchors, corners, entry + splat_whole(2 * face_count));
            const real3 normal = cross3(subtract(xyz(b), xyz(a)), subtract(xyz(c), xyz(a)));
            if (pass == 0) {
                mean = add_scaled(mean, normal, on ? one : zero);
                const real still = larger(a.w, larger(b.w, c.w)) < limit ? flat : zero;
                flat = on ? still : flat;
            } else {
                // cos^2 30 degrees = 3/4; the mean has length 1 by now.
                const real along = dot3(normal, mean);
                const mask leans = along * along < splat(0.75f) * dot3(normal, normal);
                const real faces = along > zero ? (leans ? zero : upright) : zero;
                upright = on ? faces : upright;
            }
            if (do_foresee != 0) {
                const whole next = entry + splat_whole(face_count);
                const whole last = next + splat_whole(face_count);
                const real3 way_a = gather_way(goals, corners, entry, a);
                const real3 way_b = gather_way(goals, corners, next, b);
                const real3 way_c = gather_way(goals, corners, last, c);
                if (pass == 0) {
                    drift = add_scaled(drift, add(way_a, add(way_b, way_c)), on ? one : zero);
                    ways = ways + (on ? splat(3.0f) : zero);
                } else {
                    const real most = larger(square_of(subtract(way_a, drift)),
                                             larger(square_of(subtract(way_b, drift)),
                                                    square_of(subtract(way_c, drift))));
                    const real near = most < apart * apart ? alike : zero;
                    alike = on ? near : alike;
                }
            }
        }
        if (pass == 0) mean = scale(mean, one / divisor(length3(mean)));
        if (pass == 0) drift = scale(drift, one / larger(ways, one));
    }
    const real quiet_by = flat > zero ? one : alike * splat(2.0f);
    flat = quiet_by * upright;
    const mask is_flat = flat > zero;
    mean = make3(is_flat ? mean.x : zero, is_flat ? mean.y : zero, is_flat ? mean.z : zero);
    store4(tilts, i, with_w(mean, flat));
    store4(drifts, i, with_w(drift, splat(WEFT_DRIFT_SHARE) * limit));
}

/// Which way groups of patches face, and whether each is flat and quiet: all of its patches are, by
/// themselves, and face the same way within 15 degrees.
/// patch_begin   [items + 1] where the patches of each begin
/// patch_tilts   as tilt_patches leaves them
/// tilts         [items] written: where it is flat and quiet xyz = the mean, of length 1, and w = 1;
///               else 0
WEFT_NARROW_KERNEL(tilt_groups, WEFT_GLOBAL const int* patch_begin,
                   WEFT_GLOBAL const float4* patch_tilts, WEFT_GLOBAL float4* tilts) {
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const whole begin = load_whole(patch_begin, i);
    const whole count = load_whole(patch_begin, column(i, 1, 1)) - begin;
    const whole own = first_of(begin, count);
    const int longest = largest_whole(count);
    real3 mean = make3(zero, zero, zero);
    real flat = one;
    for (int pass = 0; pass < 2; ++pass) {
        for (int k = 0; k < longest; ++k) {
            const mask on = splat_whole(k) < count;
            const real4 tilt = gather4(patch_tilts, address(on ? begin + splat_whole(k) : own));
            if (pass == 0) {
                mean = add_scaled(mean, xyz(tilt), on ? one : zero);
                flat = on ? (tilt.w == one ? flat : zero) : flat;
            } else {
                // cos 15 degrees
                const real faces = dot3(xyz(tilt), mean) >= splat(0.9659f) ? flat : zero;
                flat = on ? faces : flat;
            }
        }
        if (pass == 0) mean = scale(mean, one / divisor(length3(mean)));
    }
    const mask is_flat = flat > zero;
    mean = make3(is_flat ? mean.x : zero, is_flat ? mean.y : zero, is_flat ? mean.z : zero);
    store4(tilts, i, with_w(mean, flat));
}

/// Whether one of these patches is stale, or near to any.
WEFT_INLINE int any_of_patches(WEFT_GLOBAL const int* numbers, int first_patch, int last_patch) {
    int most = 0;
    for (int p = first_patch; p <= last_patch; ++p) most += numbers[p];
    return most > 0;
}

/// Boxes of triangles and of edges, where their patch is near another one or itself.
/// points      [vertices] xyz [m], w = reach [m]
/// corners     [corner_count * item_count] column-major
/// patches     [items] whose each is; ascending
/// near_counts [patches] how many patches are near
/// low, high   [items] written; w of high: the largest reach of the corners [m]
WEFT_KERNEL(enclose_primitives, WEFT_GLOBAL const float4* points, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const int* patches, WEFT_GLOBAL const int* near_counts,
            WEFT_GLOBAL float4* low, WEFT_GLOBAL float4* high, float margin, int corner_count,
            int item_count) {
    if (any_of_patches(near_counts, patches[i.first], patches[i.first + i.count - 1])) {
        const whole near = gather_whole(near_counts, address(load_whole(patches, i)));
        const mask on = near > splat_whole(0);
        real_box box = empty_box();
        real reach = splat(0.0f);
        for (int k = 0; k < corner_count; ++k) {
            const real4 x = gather4(points, load_index(corners, column(i, item_count, k)));
            box = united(box, box_of(x, splat(margin)));
            reach = larger(x.w, reach);
        }
        store4_where(on, low, i, with_w(box.low, splat(0.0f)));
        store4_where(on, high, i, with_w(box.high, reach));
    }
}

WEFT_KERNELS_END

#endif
