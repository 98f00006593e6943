#ifndef WEFT_KERNELS_CONTACT_STRAINS_H
#define WEFT_KERNELS_CONTACT_STRAINS_H

// Uniform strains of free solids in contact, beside their motions (bodies.h): what is at a lever r
// from the centre of mass goes E r. How a block gives way under its load is that of all of its
// vertices, too: by a few iterations it lags behind the load for many substeps, and a column of
// blocks bounces on that like on springs that are never at rest. Such a strain knows no single
// elements. Their forces add up to a virial, the sum of r g^T with g the gradients of their energy
// at the vertices; and their stiffness is about that of linear elasticity, which has no axis of its
// own and so is the same however the body has turned.
//
// A strain is six numbers, in the order of a motion: xx, yy, zz instead of the shift, and yz, xz,
// xy of the turn.
#define WEFT_VIRIAL_PARTS 2

#include "kernels/contact/bodies.h"

WEFT_KERNELS_BEGIN

/// E : A per entry of E, of a matrix A.
WEFT_INLINE body_motion strain_part(mat3 a) {
    return make_motion(make3(a.x.x, a.y.y, a.z.z),
                       make3(a.y.z + a.z.y, a.x.z + a.z.x, a.x.y + a.y.x));
}

/// The form of strains by inertia, of the mean of r r^T.
WEFT_INLINE sym6 strain_inertia(sym3 s) {
    const real zero = splat(0.0f);
    sym6 a;
    a.shift = make_sym(s.xx, zero, zero, s.yy, zero, s.zz);
    a.mixed = make_mat(make3(zero, s.yz, s.yz), make3(s.xz, zero, s.xz), make3(s.xy, s.xy, zero));
    a.turn = make_sym(s.yy + s.zz, s.xy, s.xz, s.xx + s.zz, s.yz, s.xx + s.yy);
    return a;
}

/// The form of strains of a linearly elastic solid.
/// mu, lambda  Lame's, times its volume [J]
WEFT_INLINE sym6 strain_stiffness(real mu, real lambda) {
    const real along = lambda + mu + mu;
    sym6 a = no_sym6();
    a.shift = make_sym(along, lambda, lambda, along, lambda, along);
    a.turn = diagonal_sym(splat(4.0f) * mu);
    return a;
}

/// The part of one column in the virial of its body.
/// positions, members, shares, rows  as in add_moments
/// gradients    [3 * vertices] column-major: of the elements' energy [N]
/// origins      as in add_moments
/// partials     [2 * columns] written, column-major: as a strain [J]
WEFT_KERNEL(add_virials, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float* gradients,
            WEFT_GLOBAL const int* members, WEFT_GLOBAL const float* shares,
            WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* origins,
            WEFT_GLOBAL float4* partials, int column_count, int vertex_count) {
    const real3 origin = xyz(gather4(positions, load_index(origins, i)));
    body_motion sum = no_motion();
    const int length = rows[2 * i.first + 1];
    for (int k = 0; k < length; ++k) {
        const item entry = {rows[2 * i.first] + WEFT_RUN_COLUMNS * k, i.count};
        const integer v = load_index(members, entry);
        const real3 r = subtract(xyz(gather4(positions, v)), origin);
        const real3 gradient = gather_gradient(gradients, v, vertex_count);
        const real own = load(shares, entry) > splat(0.0f) ? splat(1.0f) : splat(0.0f);
        sum = add_scaled_motion(sum, strain_part(outer_mat(r, gradient)), own);
    }
    store_motion(partials, column_count, i, sum);
}

/// A strain of no more than a tenth: a longer step says nothing of how the body gives way.
WEFT_INLINE body_motion bounded_strain(body_motion e) {
    const real most = splat(0.1f);
    const real size = square_root(dot3(e.shift, e.shift) + dot3(e.turn, e.turn));
    return add_scaled_motion(no_motion(), e, most / larger(size, most));
}

/// How far each solid has to give way, as if it were the only one.
/// lags       [12 * lag_count] as in solve_bodies, of strains
/// virials    [2 * lag_count] of the runs and more rows, column-major
/// stiffness  [2 * bodies] column-major: mu, lambda, times the volume [J]; 0: no solid
/// motions    [2 * (bodies + 1)] as solve_bodies leaves them
/// strains    [2 * (bodies + 1)] from those of the rounds before to those with this one
/// h2         the square of the substep [s^2]
/// others as in solve_bodies
WEFT_KERNEL(solve_strains, WEFT_GLOBAL const float4* lags, WEFT_GLOBAL const float4* virials,
            WEFT_GLOBAL const int* first_run, WEFT_GLOBAL const float* counts,
            WEFT_GLOBAL const float* masses, WEFT_GLOBAL const float* stiffness,
            WEFT_GLOBAL const float4* moments_of, WEFT_GLOBAL const float4* motions,
            WEFT_GLOBAL float4* strains, float h2, int most_runs, int lag_count, int body_count) {
    const real zero = splat(0.0f);
    const real one = splat(1.0f);
    const integer own_number = address(item_numbers(i));
    const moments body = gather_moments(moments_of, body_count + 1, own_number);
    const body_motion gone = gather_motion(strains, body_count + 1, own_number);
    const real3 turn = gather_motion(motions, body_count + 1, own_number).turn;
    body_sum sum = no_body_sum();
    body_motion virial = no_motion();
    const integer first = load_index(first_run, i);
    const real count = load(counts, i);
    for (int k = 0; k < most_runs; ++k) {
        const real own = splat((float)k) < count ? one : zero;
        sum = add_share(sum, gather_strain_sum(lags + k, lag_count, first), own);
        virial = add_scaled_motion(virial, gather_motion(virials + k, lag_count, first), own);
    }
    const real yielding = splat(h2) / load(masses, i);
    const real mu = load(stiffness, i);
    const sym6 elastic = strain_stiffness(mu, load(stiffness, column(i, body_count, 1)));
    const sym6 form = add_scaled_sym6(strain_inertia(body.spread), elastic, yielding);
    body_motion left = add_scaled_motion(sum.lag, strain_part(body.lags), one);
    left = add_scaled_motion(left, strain_part(turned_ways(body.spread, turn)), -one);
    left = add_scaled_motion(left, virial, -yielding);
    left = add_scaled_motion(left, multiply_sym6(form, gone), -one);
    const body_motion step = solve_sym6(add_scaled_sym6(sum.block, form, one), left);
    const real touches = trace_sym(sum.block.shift) > zero ? one : zero;
    const real on = mu > zero ? touches : zero;
    store_motion(strains, body_count + 1, i, bounded_strain(add_scaled_motion(gone, step, on)));
}

WEFT_KERNELS_END

#endif
