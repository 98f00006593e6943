#ifndef WEFT_KERNELS_CONTACT_TRUNCATE_H
#define WEFT_KERNELS_CONTACT_TRUNCATE_H

#include "kernels/contact/truncation.h"

/// Rounds of taking out what leads through planes, before the rest of the way is scaled.
#define WEFT_KEEPING_ROUNDS 3
/// Rounds of making way for planes that come.
#define WEFT_FOOTHOLD_ROUNDS 8

WEFT_KERNELS_BEGIN

/// A way, and how far it led through a plane, negative; 0: nowhere [m].
typedef struct {
    real3 way;
    real through;
} turned_way;

/// The end of a way, and how much the foothold lacks to be before all planes [m], if it does; half
/// of what stays between it and them is left for rounding.
typedef struct {
    real3 way;
    real lack;
} kept_way;

/// A round of taking out of a way what leads through planes: where there was nothing, the next
/// round will find nothing, either.
WEFT_INLINE turned_way turn_before(WEFT_GLOBAL const float4* planes, whole start, whole count,
                                   real3 way, float soft) {
    turned_way w = {way, splat(0.0f)};
    const int longest = largest_whole(count);
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
        const real4 plane = gather4(planes, entry);
        const real room = on ? room_before(plane.w, splat(soft)) : splat(1e30f);
        w.through = smaller(w.through, dot3(w.way, xyz(plane)) + room);
        const real3 kept = keep_before(w.way, xyz(plane), room);
        w.way = kept;
    }
    return w;
}

/// As much of a way as lies before all planes, going on from the foothold.
WEFT_INLINE kept_way share_of_way(WEFT_GLOBAL const float4* planes, whole start, whole count,
                                  real3 foothold, real3 way, float hard) {
    real share = splat(1.0f);
    real lack = splat(0.0f);
    const int longest = largest_whole(count);
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
        const real4 plane = gather4(planes, entry);
        const real room = room_before(plane.w, splat(hard));
        const real part = share_before(foothold, way, xyz(plane), room);
        share = on ? smaller(share, part) : share;
        const real stays = smaller(larger(plane.w, splat(0.0f)), splat(hard));
        const real missing = -(dot3(foothold, xyz(plane)) + room);
        lack = on ? larger(lack, missing - splat(0.5f) * stays) : lack;
    }
    kept_way kept = {between3(foothold, way, share), lack};
    return kept;
}

/// A way within a vertex' ball and before all its planes.
/// start, count  the vertex' row of planes
/// foothold      from which the planes let go on
/// makes_way     whether a foothold is not the anchor
/// soft, hard    as in truncate_contacts
WEFT_INLINE kept_way way_before(WEFT_GLOBAL const float4* planes, whole start, whole count,
                                real3 foothold, int makes_way, real3 wanted, float soft,
                                float hard) {
    const real one = splat(1.0f);
    const real zero = splat(0.0f);
    turned_way w = {wanted, -one};
    for (int round = 0; round < WEFT_KEEPING_ROUNDS && any_item(w.through < zero); ++round) {
        w = turn_before(planes, start, count, w.way, soft);
    }
    // Where nothing is left to take out, all planes are kept by `soft`, and so by less, too.
    if (makes_way || soft < hard || any_item(w.through < zero)) {
        return share_of_way(planes, start, count, foothold, w.way, hard);
    }
    kept_way kept = {between3(foothold, w.way, one), zero};
    return kept;
}

/// Where planes come over a vertex' anchor: how far it has to make way for them. Zero elsewhere.
WEFT_INLINE real3 foothold_before(WEFT_GLOBAL const float4* planes, whole start, whole count) {
    const real zero = splat(0.0f);
    real3 way = make3(zero, zero, zero);
    const int longest = largest_whole(count);
    for (int round = 0; round < WEFT_FOOTHOLD_ROUNDS; ++round) {
        for (int k = 0; k < longest; ++k) {
            const mask on = splat_whole(k) < count;
            const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
            const real4 plane = gather4(planes, entry);
            way = keep_before(way, xyz(plane), on ? plane.w : splat(1e30f));
        }
    }
    return way;
}

/// As much of a way as lies in a ball around its start.
WEFT_INLINE real3 within_ball(real3 way, real radius) {
    const real length = length3(way);
    return scale(way, length > radius ? radius / divisor(length) : splat(1.0f));
}

/// Whether a way lacks more than a thousandth of the one that was wanted.
WEFT_INLINE mask is_taken_back(mask on, real3 way, real3 wanted) {
    const real3 lacks = subtract(way, wanted);
    return both(on, dot3(lacks, lacks) > splat(1e-6f) * dot3(wanted, wanted));
}

/// The last word about positions: takes vertices back to where no contact forbids them to be.
/// positions  [vertices] xyz [m], w = 1/mass [1/kg]; written where it changes
/// anchors    [vertices] xyz: where each was when contacts were found [m], w: its ball's radius [m]
/// least      [vertices] the least distance of its planes from the anchor [m]
/// rows       [2 * vertices] column-major: where the vertex' planes start, room for how many
/// counts     [vertices] how many there are
/// planes     [entries] xyz: n, w: how far the anchor lies before where the plane ends [m]
/// cut        [vertices] written by what holds all: 1 where the vertex was taken back by more than a
///            thousandth of its way, 2 where it found no place that all its planes and its ball
///            allow, else 0
/// soft       what stays between plane and vertex where only that has to yield [m]
/// hard       what stays at least [m]
/// all_from   the iteration from which on vertices without planes are held in their balls, too:
///            nobody sees them before
WEFT_NARROW_KERNEL(truncate_contacts, WEFT_GLOBAL float4* positions,
                   WEFT_GLOBAL const float4* anchors, WEFT_GLOBAL const float* least,
                   WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* counts,
                   WEFT_GLOBAL const float4* planes, WEFT_GLOBAL int* cut, float soft, float hard,
                   int iteration, int all_from) {
    const real nearest = load(least, i);
    const mask has_planes = nearest < splat(WEFT_NO_PLANE);
    const int all = iteration >= all_from;
    if (!all && !any_item(has_planes)) return;
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const real4 x = load4(positions, i);
    const real4 ball = load4(anchors, i);
    const real3 anchor = xyz(ball);
    const real3 wanted = subtract(xyz(x), anchor);
    const real radius = ball.w;
    const real free = larger(smaller(nearest - splat(soft), radius), zero);
    // A plane that comes over the anchor has to be looked at even by what does not move.
    const real pushed = nearest < zero ? one : dot3(wanted, wanted) - free * free;
    const real asked = all ? pushed : (has_planes ? pushed : zero);
    const real excess = x.w > zero ? asked : zero;
    const mask out = excess > zero;
    whole result = splat_whole(0);
    if (any_item(out)) {
        const whole start = load_whole(rows, i);
        const whole row = load_whole(counts, i);
        const whole count = out ? row : splat_whole(0);
        real3 foothold = make3(zero, zero, zero);
        const int makes_way = smallest_real(nearest) < 0.0f;
        if (makes_way) foothold = foothold_before(planes, start, count);
        const kept_way kept = way_before(planes, start, count, foothold, makes_way,
                                         within_ball(wanted, radius), soft, hard);
        const real3 way = kept.way;
        // Planes may have led it out of the ball again; between here and the foothold all is well.
        const real from = length3(foothold);
        const real rest = length3(subtract(way, foothold));
        const real left = larger(radius - from, zero);
        const real share = rest > left ? left / divisor(rest) : one;
        const real3 end = add(anchor, between3(foothold, way, share));
        store4_where(out, positions, i, with_w(end, x.w));
        const mask is_cut = is_taken_back(out, subtract(end, anchor), wanted);
        const real rounding = splat(7e-7f) * length3(anchor) + splat(1e-4f) * from;
        const real beyond = larger(kept.lack - rounding, from - radius);
        const mask is_lost = both(out, beyond > zero);
        result = is_lost ? splat_whole(2) : (is_cut ? splat_whole(1) : result);
    }
    if (all) store_whole(cut, i, result);
}

/// The same where no vertex has planes: in strips that touch nothing.
/// Parameters as in truncate_contacts
WEFT_KERNEL(hold_in_balls, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const float4* anchors,
            WEFT_GLOBAL int* cut, int iteration, int all_from) {
    if (iteration < all_from) return;
    const real zero = splat(0.0f);
    const real4 x = load4(positions, i);
    const real4 ball = load4(anchors, i);
    const real3 wanted = subtract(xyz(x), xyz(ball));
    const real radius = larger(ball.w, zero);
    const real excess = x.w > zero ? dot3(wanted, wanted) - radius * radius : zero;
    const mask out = excess > zero;
    whole result = splat_whole(0);
    if (any_item(out)) {
        const real3 end = add(xyz(ball), within_ball(within_ball(wanted, radius), radius));
        store4_where(out, positions, i, with_w(end, x.w));
        result = is_taken_back(out, subtract(end, xyz(ball)), wanted) ? splat_whole(1) : result;
    }
    store_whole(cut, i, result);
}

WEFT_KERNELS_END

#endif
