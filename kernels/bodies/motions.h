#ifndef WEFT_KERNELS_BODIES_MOTIONS_H
#define WEFT_KERNELS_BODIES_MOTIONS_H

// Motions of a body as a whole: a shift of its centre of mass, and a turn about it. A turn w is a
// vector along the axis, and stands for the rotation whose Rodrigues parameters are w/2 (Cayley's
// map): basic arithmetic makes a proper one of it, so that bodies are not inflated, and for a small
// one it is w x r.
//
// Quadratic forms of motions, 1/2 m^T A m, have three blocks of 3x3: of shifts, mixed, of turns.

#include "kernels/matrix.h"

WEFT_KERNELS_BEGIN

typedef struct {
    real3 shift;  ///< [m]
    real3 turn;
} body_motion;

typedef struct {
    sym3 shift;
    mat3 mixed;  ///< shift^T mixed turn
    sym3 turn;
} sym6;

WEFT_INLINE body_motion make_motion(real3 shift, real3 turn) {
    body_motion m = {shift, turn};
    return m;
}

WEFT_INLINE body_motion no_motion(void) {
    const real zero = splat(0.0f);
    return make_motion(make3(zero, zero, zero), make3(zero, zero, zero));
}

/// a + b * s
WEFT_INLINE body_motion add_scaled_motion(body_motion a, body_motion b, real s) {
    return make_motion(add_scaled(a.shift, b.shift, s), add_scaled(a.turn, b.turn, s));
}

/// Where a turn leads what is at a lever from its centre: R r - r.
WEFT_INLINE real3 way_of_turn(real3 turn, real3 lever) {
    const real one = splat(1.0f);
    const real3 way = cross3(turn, lever);
    const real3 twice = add_scaled(way, cross3(turn, way), splat(0.5f));
    return scale(twice, one / (one + splat(0.25f) * dot3(turn, turn)));
}

WEFT_INLINE real3 way_of_motion(body_motion m, real3 lever) {
    return add(m.shift, way_of_turn(m.turn, lever));
}

/// A turn of no more than about half a radian: whatever a longer one came from says nothing of it.
WEFT_INLINE real3 bounded_turn(real3 turn) {
    const real most = splat(0.5f);
    return scale(turn, most / larger(length3(turn), most));
}

/// sum u x v, of the matrix sum u v^T
WEFT_INLINE real3 axis_of(mat3 a) { return make3(a.z.y - a.y.z, a.x.z - a.z.x, a.y.x - a.x.y); }

/// What takes turns to ways at a lever: w x r = lever_mat(r) w.
WEFT_INLINE mat3 lever_mat(real3 lever) { return cross_mat(scale(lever, splat(-1.0f))); }

WEFT_INLINE mat3 multiply_sym_mat(sym3 a, mat3 b) {
    return make_mat(multiply_sym(a, b.x), multiply_sym(a, b.y), multiply_sym(a, b.z));
}

/// The upper half of a^T b: all of it where that is symmetric.
WEFT_INLINE sym3 inner_sym(mat3 a, mat3 b) {
    return make_sym(dot3(a.x, b.x), dot3(a.x, b.y), dot3(a.x, b.z), dot3(a.y, b.y), dot3(a.y, b.z),
                    dot3(a.z, b.z));
}

WEFT_INLINE sym6 no_sym6(void) {
    const sym3 none = diagonal_sym(splat(0.0f));
    const real3 zero = no_motion().shift;
    sym6 a = {none, make_mat(zero, zero, zero), none};
    return a;
}

/// a + b * s
WEFT_INLINE sym6 add_scaled_sym6(sym6 a, sym6 b, real s) {
    a.shift = add_sym(a.shift, scale_sym(b.shift, s));
    a.mixed = make_mat(add_scaled(a.mixed.x, b.mixed.x, s), add_scaled(a.mixed.y, b.mixed.y, s),
                       add_scaled(a.mixed.z, b.mixed.z, s));
    a.turn = add_sym(a.turn, scale_sym(b.turn, s));
    return a;
}

WEFT_INLINE body_motion multiply_sym6(sym6 a, body_motion m) {
    return make_motion(
        add(multiply_sym(a.shift, m.shift), multiply_mat(a.mixed, m.turn)),
        add(multiply_transposed_mat(a.mixed, m.shift), multiply_sym(a.turn, m.turn)));
}

/// The form of motions about a centre, of one of the ways of a point at a lever from it.
WEFT_INLINE sym6 form_at_lever(sym3 form, real3 lever) {
    const mat3 arm = lever_mat(lever);
    sym6 a = {form, multiply_sym_mat(form, arm), diagonal_sym(splat(0.0f))};
    a.turn = inner_sym(arm, a.mixed);
    return a;
}

/// The form of what takes a point by the ways arm * shift + other_arm * turn.
WEFT_INLINE sym6 form_of_arms(sym3 form, mat3 arm, mat3 other_arm) {
    const mat3 pull = multiply_sym_mat(form, arm);
    const mat3 other_pull = multiply_sym_mat(form, other_arm);
    sym6 a;
    a.shift = inner_sym(arm, pull);
    a.mixed = make_mat(multiply_transposed_mat(arm, other_pull.x),
                       multiply_transposed_mat(arm, other_pull.y),
                       multiply_transposed_mat(arm, other_pull.z));
    a.turn = inner_sym(other_arm, other_pull);
    return a;
}

/// Where a strain leads what is at a lever: E r (contact/strains.h).
WEFT_INLINE real3 way_of_strain(body_motion e, real3 r) {
    return make3(e.shift.x * r.x + e.turn.z * r.y + e.turn.y * r.z,
                 e.turn.z * r.x + e.shift.y * r.y + e.turn.x * r.z,
                 e.turn.y * r.x + e.turn.x * r.y + e.shift.z * r.z);
}

/// What takes the first three numbers of a strain to ways at a lever,
WEFT_INLINE mat3 stretch_mat(real3 r) {
    const real zero = splat(0.0f);
    return make_mat(make3(r.x, zero, zero), make3(zero, r.y, zero), make3(zero, zero, r.z));
}

/// and the last three.
WEFT_INLINE mat3 shear_mat(real3 r) {
    const real zero = splat(0.0f);
    return make_mat(make3(zero, r.z, r.y), make3(r.z, zero, r.x), make3(r.y, r.x, zero));
}

/// The form of motions about another centre, from which the own one is at a lever.
WEFT_INLINE sym6 form_from(sym6 a, real3 lever) {
    const mat3 arm = lever_mat(lever);
    sym6 moved = form_at_lever(a.shift, lever);
    const sym3 both_ways = add_sym(inner_sym(arm, a.mixed), inner_sym(a.mixed, arm));
    moved.turn = add_sym(add_sym(moved.turn, a.turn), both_ways);
    moved.mixed = add_mat(moved.mixed, a.mixed);
    return moved;
}

/// Solves a m = b for a positive semi-definite `a` whose block of shifts is not singular.
WEFT_INLINE body_motion solve_sym6(sym6 a, body_motion b) {
    const sym3_factors f = factor_sym(a.shift);
    const real3 alone = solve_factored(f, b.shift);
    const mat3 along = make_mat(solve_factored(f, a.mixed.x), solve_factored(f, a.mixed.y),
                                solve_factored(f, a.mixed.z));
    const sym3 taken = inner_sym(a.mixed, along);
    const real3 torque = subtract(b.turn, multiply_transposed_mat(a.mixed, alone));
    const real3 turn = solve_sym(add_sym(a.turn, scale_sym(taken, splat(-1.0f))), torque);
    return make_motion(subtract(alone, multiply_mat(along, turn)), turn);
}

/// motions  [2 * rows] column-major: of each body its shift and its turn
WEFT_INLINE body_motion gather_motion(WEFT_GLOBAL const float4* motions, int rows, integer body) {
    return make_motion(xyz(gather4(motions, body)), xyz(gather4(motions + rows, body)));
}

WEFT_INLINE void store_motion(WEFT_GLOBAL float4* motions, int rows, item i, body_motion m) {
    store4(motions, i, with_w(m.shift, splat(0.0f)));
    store4(motions, column(i, rows, 1), with_w(m.turn, splat(0.0f)));
}

/// forms  [5 * rows] column-major: all of a form but mixed.z.z, for which others have room
WEFT_INLINE void store_sym6(WEFT_GLOBAL float4* forms, int rows, item i, sym6 a) {
    const real4 part0 = {a.shift.xx, a.shift.xy, a.shift.xz, a.shift.yy};
    const real4 part1 = {a.shift.yz, a.shift.zz, a.turn.xx, a.turn.xy};
    const real4 part2 = {a.turn.xz, a.turn.yy, a.turn.yz, a.turn.zz};
    const real4 part3 = {a.mixed.x.x, a.mixed.x.y, a.mixed.x.z, a.mixed.y.x};
    const real4 part4 = {a.mixed.y.y, a.mixed.y.z, a.mixed.z.x, a.mixed.z.y};
    store4(forms, i, part0);
    store4(forms, column(i, rows, 1), part1);
    store4(forms, column(i, rows, 2), part2);
    store4(forms, column(i, rows, 3), part3);
    store4(forms, column(i, rows, 4), part4);
}

WEFT_INLINE sym6 gather_sym6(WEFT_GLOBAL const float4* forms, int rows, integer k, real mixed_zz) {
    const real4 p0 = gather4(forms, k);
    const real4 p1 = gather4(forms + rows, k);
    const real4 p2 = gather4(forms + 2 * rows, k);
    const real4 p3 = gather4(forms + 3 * rows, k);
    const real4 p4 = gather4(forms + 4 * rows, k);
    sym6 a;
    a.shift = make_sym(p0.x, p0.y, p0.z, p0.w, p1.x, p1.y);
    a.turn = make_sym(p1.z, p1.w, p2.x, p2.y, p2.z, p2.w);
    a.mixed = make_mat(xyz(p3), make3(p3.w, p4.x, p4.y), make3(p4.z, p4.w, mixed_zz));
    return a;
}

WEFT_KERNELS_END

#endif
