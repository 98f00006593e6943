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

/// Around boxes that follow each other.
/// begin, count  of them
WEFT_INLINE real_box around_boxes(WEFT_GLOBAL const float4* low, WEFT_GLOBAL const float4* high,
                                  whole begin, whole count) {
    const whole own = first_of(begin, count);
    const int longest = largest_whole(count);
    real_box box = empty_box();
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer child = address(on ? begin + splat_whole(k) : own);
        real_box of_child;
        of_child.low = xyz(gather4(low, child));
        of_child.high = xyz(gather4(high, child));
        const real_box both_boxes = united(box, of_child);
        box.low.x = on ? both_boxes.low.x : box.low.x;
        box.low.y = on ? both_boxes.low.y : box.low.y;
        box.low.z = on ? both_boxes.low.z : box.low.z;
        box.high.x = on ? both_boxes.high.x : box.high.x;
        box.high.y = on ? both_boxes.high.y : box.high.y;
        box.high.z = on ? both_boxes.high.z : box.high.z;
    }
    return box;
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
    const real_box box = around_boxes(child_low, child_high, begin, count);
    store4(low, i, with_w(box.low, splat(0.0f)));
    store4(high, i, with_w(box.high, splat(0.0f)));
}

/// Their sums and differences likewise.
/// slant_low, slant_high   [2 * patch_count] as enclose_patches leaves them
/// low, high               [2 * items] column-major, written
WEFT_NARROW_KERNEL(enclose_slants, WEFT_GLOBAL const int* child_begin,
                   WEFT_GLOBAL const float4* slant_low, WEFT_GLOBAL const float4* slant_high,
                   WEFT_GLOBAL float4* low, WEFT_GLOBAL float4* high, int patch_count,
                   int item_count) {
    const whole begin = load_whole(child_begin, i);
    const whole count = load_whole(child_begin, column(i, 1, 1)) - begin;
    const real_box sums = around_boxes(slant_low, slant_high, begin, count);
    const real_box differences =
        around_boxes(slant_low + patch_count, slant_high + patch_count, begin, count);
    const item second = column(i, item_count, 1);
    store4(low, i, with_w(sums.low, splat(0.0f)));
    store4(high, i, with_w(sums.high, splat(0.0f)));
    store4(low, second, with_w(differences.low, splat(0.0f)));
    store4(high, second, with_w(differences.high, splat(0.0f)));
}

/// Whether one of the numbers from first to last is not 0; none is negative.
WEFT_INLINE int any_in_range(WEFT_GLOBAL const int* numbers, int first, int last) {
    if (numbers[first] > 0 || numbers[last] > 0) return 1;
    for (int n = first + 1; n < last; ++n)
        if (numbers[n] > 0) return 1;
    return 0;
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
    if (any_in_range(near_counts, patches[i.first], patches[i.first + i.count - 1])) {
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
