#ifndef WEFT_KERNELS_CONTACT_TILTS_H
#define WEFT_KERNELS_CONTACT_TILTS_H

// Which way patches of a surface face, and groups of them; and which are so flat, and so quiet,
// that they cannot fold in a substep (near.h passes over these).

#include "kernels/contact/boxes.h"

WEFT_KERNELS_BEGIN

// Shares of the largest way that counts as quiet (tilt_patches): two vertices may come nearer to
// each other by twice that. Inertia may lead vertices of one patch so far from their mean,
#define WEFT_SPREAD_SHARE 0.125f
// means of patches beside each other so far apart,
#define WEFT_DRIFT_SHARE 0.25f
// and a vertex may go so far from where inertia led it. 2 * 0.125 + 0.25 + 2 * 0.75 = 2.
#define WEFT_LOOSE_SHARE 0.75f
// What may be used up of it before a patch that was flat is looked at again. No more than this,
// because what is kept has no drift to compare with that of a patch beside it which goes farther.
#define WEFT_WORN_SHARE 0.75f

/// A corner of a triangle each, in column-major tables.
WEFT_INLINE real4 gather_corner(WEFT_GLOBAL const float4* anchors, WEFT_GLOBAL const int* corners,
                                whole entry) {
    return gather4(anchors, address(gather_whole(corners, address(entry))));
}

WEFT_INLINE real3 gather_normal(WEFT_GLOBAL const float4* anchors, WEFT_GLOBAL const int* corners,
                                whole entry, int face_count) {
    const real4 a = gather_corner(anchors, corners, entry);
    const real4 b = gather_corner(anchors, corners, entry + splat_whole(face_count));
    const real4 c = gather_corner(anchors, corners, entry + splat_whole(2 * face_count));
    return cross3(subtract(xyz(b), xyz(a)), subtract(xyz(c), xyz(a)));
}

WEFT_INLINE real square_of(real3 a) { return dot3(a, a); }

/// So many normals or ways of a patch are kept from the first look at them to the second; what
/// comes behind is found anew.
#define WEFT_KEPT 24

/// The mean of the normals of a patch's faces, of length 1; w: 1 where all lie within 30 degrees of
/// it, else 0.
/// begin, count  of its faces; begin is read in any case
WEFT_INLINE real4 facing_of(WEFT_GLOBAL const float4* anchors, WEFT_GLOBAL const int* corners,
                            whole begin, whole count, int face_count) {
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const int longest = largest_whole(count);
    real3 normals[WEFT_KEPT];
    real3 mean = make3(zero, zero, zero);
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const whole entry = on ? begin + splat_whole(k) : begin;
        const real3 normal = gather_normal(anchors, corners, entry, face_count);
        if (k < WEFT_KEPT) normals[k] = normal;
        mean = add_scaled(mean, normal, on ? one : zero);
    }
    mean = scale(mean, one / divisor(length3(mean)));
    real upright = one;
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const whole entry = on ? begin + splat_whole(k) : begin;
        real3 normal;
        if (k < WEFT_KEPT)
            normal = normals[k];
        else
            normal = gather_normal(anchors, corners, entry, face_count);
        // cos^2 30 degrees = 3/4; the mean has length 1.
        const real along = dot3(normal, mean);
        const mask leans = along * along < splat(0.75f) * dot3(normal, normal);
        const real faces = along > zero ? (leans ? zero : upright) : zero;
        upright = on ? faces : upright;
    }
    return with_w(mean, upright);
}

/// Where inertia leads a patch.
typedef struct {
    real3 drift;  ///< the mean of the ways of its vertices [m]
    real alike;   ///< 1 where none is farther from it than `apart`, else 0
    real reach;   ///< how far one of them may get [m]
} real_lead;

/// By inertia, or as the scene leads.
WEFT_INLINE real3 gather_way(WEFT_GLOBAL const float4* goals, integer vertex, real4 anchor) {
    return subtract(xyz(gather4(goals, vertex)), xyz(anchor));
}

/// begin, count  of a patch's vertices in `rims`; begin is read in any case
/// foresees      0: drift and alike are 0
WEFT_INLINE real_lead lead_of(WEFT_GLOBAL const float4* anchors, WEFT_GLOBAL const float4* goals,
                              WEFT_GLOBAL const int* rims, whole begin, whole count, int foresees,
                              real apart) {
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const int longest = largest_whole(count);
    real3 ways[WEFT_KEPT];
    real number = zero;
    real_lead lead = {make3(zero, zero, zero), zero, zero};
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer vertex =
            address(gather_whole(rims, address(on ? begin + splat_whole(k) : begin)));
        const real4 anchor = gather4(anchors, vertex);
        lead.reach = on ? larger(anchor.w, lead.reach) : lead.reach;
        if (foresees != 0) {
            const real3 way = gather_way(goals, vertex, anchor);
            if (k < WEFT_KEPT) ways[k] = way;
            lead.drift = add_scaled(lead.drift, way, on ? one : zero);
            number = number + (on ? one : zero);
        }
    }
    if (foresees == 0) return lead;
    lead.drift = scale(lead.drift, one / larger(number, one));
    lead.alike = one;
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        real3 way;
        if (k < WEFT_KEPT) {
            way = ways[k];
        } else {
            const integer vertex =
                address(gather_whole(rims, address(on ? begin + splat_whole(k) : begin)));
            way = gather_way(goals, vertex, gather4(anchors, vertex));
        }
        // NaN is not near.
        const real near = square_of(subtract(way, lead.drift)) < apart * apart ? lead.alike : zero;
        lead.alike = on ? near : lead.alike;
    }
    return lead;
}

/// How much a substep uses up of a patch's quiet: how far its vertices have moved against each
/// other since the one before (half of it by each), and by how much one of them gets farther [m].
/// rim, count  its vertices in `rims`; rim is read in any case
WEFT_INLINE real wear_of(WEFT_GLOBAL const float4* strides, WEFT_GLOBAL const int* rims, whole rim,
                         whole count) {
    const int longest = largest_whole(count);
    real_box box = empty_box();
    real growth = splat(-1e30f);
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer entry = address(on ? rim + splat_whole(k) : rim);
        const real4 stride = gather4(strides, address(gather_whole(rims, entry)));
        box = united(box, box_around(xyz(stride), splat(0.0f)));
        growth = larger(stride.w, growth);
    }
    const real wear = splat(0.5f) * length3(subtract(box.high, box.low)) + growth;
    return count > splat_whole(0) ? wear : splat(0.0f);
}

/// What a look at a patch's normals and ways says.
typedef struct {
    real4 tilt, drift;  ///< see tilt_patches
    real reach;         ///< how far a vertex of one that is quiet by itself may get [m]; else 0
} patch_look;

/// do_foresee           0: nothing counts but how far vertices may get
/// corners, face_count  [3 * face_count] column-major: model vertices
/// rim, rim_count       the patches' vertices in `rims`
/// is_slow              patches whose vertices cannot get as far as `limit`
/// limit                how far vertices may get, for a patch to be quiet [m]
/// asked                1 for patches to look at, 0 for those of which nobody needs to know
/// What is not named here is as in tilt_patches.
WEFT_INLINE patch_look look_at_patches(WEFT_GLOBAL const float4* anchors,
                                       WEFT_GLOBAL const float4* goals, int do_foresee,
                                       WEFT_GLOBAL const int* face_begin,
                                       WEFT_GLOBAL const int* corners, WEFT_GLOBAL const int* rims,
                                       whole rim, whole rim_count, mask is_slow, real limit,
                                       whole asked, int face_count, item i) {
    const real zero = splat(0.0f);
    const whole none = splat_whole(0);
    const whole face = load_whole(face_begin, i);
    const whole faces = load_whole(face_begin, column(i, 1, 1)) - face;
    // What is not quiet by itself need not be looked at, if nothing is foreseen.
    const int looks = do_foresee != 0 || any_item(is_slow);
    const real_lead lead = lead_of(anchors, goals, rims, rim, looks ? rim_count * asked : none,
                                   do_foresee, splat(WEFT_SPREAD_SHARE) * limit);
    const real still = lead.reach < limit ? splat(1.0f) : zero;
    const real by_itself = is_slow ? still : zero;
    const real quiet_by = by_itself > zero ? by_itself : lead.alike * splat(2.0f);
    const whole may_be = quiet_by > zero ? asked : none;
    const real4 facing =
        facing_of(anchors, corners, first_of(face, faces), faces * may_be, face_count);
    const real flat = quiet_by * facing.w;
    const mask is_flat = flat > zero;
    const real3 mean =
        make3(is_flat ? facing.x : zero, is_flat ? facing.y : zero, is_flat ? facing.z : zero);
    patch_look look = {with_w(mean, flat), with_w(lead.drift, splat(WEFT_DRIFT_SHARE) * limit),
                       flat == splat(1.0f) ? lead.reach : zero};
    return look;
}

/// Which way patches face, and whether each is flat and quiet: its normals lie within 30 degrees of
/// their mean, and no vertex gets so far that a triangle could turn over; or all are led so alike
/// by their inertia that none does, as long as they follow it. (quiet.h looks whether they did.)
///
/// No triangle turns over as long as no vertex gets that far from where it was when normals were
/// looked at, but for a translation of all. So what was flat and quiet by itself then stays so
/// until most of it may have been used up, and only a frame's first substep looks at all patches.
/// goals       [vertices] xyz: where inertia, or the scene, leads [m]
/// strides     [vertices] as begin_contacts leaves them
/// foresees    [1] 0: nothing counts but how far vertices may get
/// face_begin  [items + 1] where the faces of each begin (Surface::faces)
/// corners     [3 * face_count] column-major: model vertices
/// rim_begin, rims   [items + 1], [entries] the vertices of these faces, each once
/// high        [items] as enclose_patches leaves it
/// quiet       [items] how far vertices may get [m]
/// worn        [items] written: how far they may get by the substep's end from where they were at
///             the last look [m]
/// tilts       [items] written: where it is flat and quiet xyz = the mean of the normals, of length
///             1, and w = 1, or 2 where it is quiet by inertia alone; else 0
/// drifts      [items] written: xyz: the mean of the ways [m], w: how far apart ways of patches
///             beside it may be [m]; both 0 where nobody looked
WEFT_NARROW_KERNEL(tilt_patches, WEFT_GLOBAL const float4* anchors, WEFT_GLOBAL const float4* goals,
                   WEFT_GLOBAL const float4* strides, WEFT_GLOBAL const int* foresees,
                   WEFT_GLOBAL const int* face_begin, WEFT_GLOBAL const int* corners,
                   WEFT_GLOBAL const int* rim_begin, WEFT_GLOBAL const int* rims,
                   WEFT_GLOBAL const float4* high, WEFT_GLOBAL const float* quiet,
                   WEFT_GLOBAL float* worn, WEFT_GLOBAL float4* tilts, WEFT_GLOBAL float4* drifts,
                   int face_count, int instance) {
    const real zero = splat(0.0f);
    const whole none = splat_whole(0);
    const whole one = splat_whole(1);
    const whole begin = load_whole(rim_begin, i);
    const whole rim_count = load_whole(rim_begin, column(i, 1, 1)) - begin;
    const whole rim = first_of(begin, rim_count);
    const real limit = load(quiet, i);
    const real4 before = load4(tilts, i);
    const whole was_flat = instance == 0 ? none : (before.w == splat(1.0f) ? one : none);
    real wear = zero;
    if (any_item(was_flat > none)) {
        wear = load(worn, i) + wear_of(strides, rims, rim, rim_count * was_flat);
    }
    const whole stays = wear < splat(WEFT_WORN_SHARE) * limit ? was_flat : none;
    const whole asked = one - stays;
    const mask is_asked = asked > none;
    patch_look look = {before, {zero, zero, zero, zero}, zero};
    if (any_item(is_asked)) {
        look = look_at_patches(anchors, goals, foresees[0], face_begin, corners, rims, rim,
                               rim_count, load4(high, i).w < limit, limit, asked, face_count, i);
    }
    store(worn, i, is_asked ? look.reach : wear);
    store4_where(is_asked, tilts, i, look.tilt);
    const real kept = is_asked ? splat(1.0f) : zero;
    store4(drifts, i, with_w(scale(xyz(look.drift), kept), look.drift.w * kept));
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

WEFT_KERNELS_END

#endif
