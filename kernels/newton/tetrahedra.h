#ifndef WEFT_KERNELS_NEWTON_TETRAHEDRA_H
#define WEFT_KERNELS_NEWTON_TETRAHEDRA_H

#include "kernels/energies/tetrahedron.h"
#include "kernels/newton/blocks.h"
#include "kernels/tetrahedra.h"

WEFT_KERNELS_BEGIN

/// How a tetrahedron resists a change dF of F. With R the rotation nearest to F and s the size of
/// F / R, and D = R^T dF with its symmetric part S and the rest A,
///   2 d2J = s (tr(D)^2 - |S|^2 + |A|^2)
/// where F = s R, and nearly so where strains are small. Then the quadratic form is
///   (mu - p s) |S - tr(D)/3 I|^2 + (mu + p s) |A|^2 + (lambda + (mu + 2 p s) / (3 s^4)) (dJ)^2
/// of which no factor may be negative; at rest the second one is 0, as it must be for a rotation.
typedef struct {
    mat3 rotation;  ///< R; 0 where F is nearly flat or inverted
    real shear;     ///< mu - p s
    real turn;      ///< mu + p s
    real growth;    ///< of (dJ)^2
} tetrahedron_resistance;

/// R by Newton's method, R <- (R + R^-T) / 2, which has squared the error in every step when R
/// is near: (Higham 1986). Four steps are enough for stretches of a third to three.
WEFT_INLINE mat3 rotation_near(mat3 map, real inverse_size) {
    mat3 r = scale_mat(map, inverse_size);
    for (int k = 0; k < 4; ++k) {
        const mat3 c = cofactor_mat(r);
        const real inverse = splat(0.5f) / larger(dot3(r.x, c.x), splat(0.01f));
        r = add_mat(scale_mat(r, splat(0.5f)), scale_mat(c, inverse));
    }
    return r;
}

WEFT_INLINE tetrahedron_resistance resistance_of(tetrahedron t) {
    const real zero = splat(0.0f);
    const real third = splat(1.0f / 3.0f);
    const real square =
        third * (dot3(t.map.x, t.map.x) + dot3(t.map.y, t.map.y) + dot3(t.map.z, t.map.z));
    const real size = square_root(square);
    const real inverse = splat(1.0f) / divisor(size);
    const real ratio = t.jacobian * inverse * inverse * inverse;
    const real is_near = ratio > splat(0.1f) ? splat(1.0f) : zero;
    const real pressure = t.pressure * size;
    tetrahedron_resistance r;
    r.rotation = scale_mat(rotation_near(t.map, inverse), is_near);
    // Where there is no rotation to go by: mu |dF|^2 + lambda (dJ)^2.
    const real shear = larger(t.mu - pressure, zero);
    const real turn = larger(t.mu + pressure, zero);
    const real by_size =
        third * (t.mu + pressure + pressure) * inverse * inverse * inverse * inverse;
    r.shear = is_near > zero ? shear : t.mu;
    r.turn = is_near > zero ? turn : t.mu;
    r.growth = is_near > zero ? larger(t.lambda + by_size, zero) : t.lambda;
    return r;
}

/// The blocks of corners with shape gradients b_j and b_k [N/m].
WEFT_INLINE mat3 tetrahedron_clamped(tetrahedron t, tetrahedron_resistance r, real3 b_j,
                                     real3 b_k) {
    const real one_half = splat(0.5f);
    const real3 c_j = multiply_mat(t.cofactor, b_j);
    const real3 c_k = multiply_mat(t.cofactor, b_k);
    const real3 r_j = multiply_mat(r.rotation, b_j);
    const real3 r_k = multiply_mat(r.rotation, b_k);
    const mat3 growth = outer_mat(c_j, scale(c_k, r.growth));
    const mat3 trace = outer_mat(r_j, scale(r_k, r.shear * splat(-1.0f / 3.0f)));
    const mat3 crossed = outer_mat(r_k, scale(r_j, one_half * (r.shear - r.turn)));
    return add_diagonal_mat(add_mat(add_mat(growth, trace), crossed),
                            one_half * (r.shear + r.turn) * dot3(b_j, b_k));
}

WEFT_INLINE void store_element_block(WEFT_GLOBAL float4* blocks, integer place, int pair, mat3 a) {
    const real zero = splat(0.0f);
    scatter4(blocks + 3 * pair, place, with_w(a.x, zero));
    scatter4(blocks + 3 * pair + 1, place, with_w(a.y, zero));
    scatter4(blocks + 3 * pair + 2, place, with_w(a.z, zero));
}

/// What each tetrahedron gives to the blocks, for sum_element_blocks: of corners 0 and 1, 0 and 2,
/// 0 and 3, 1 and 2, 1 and 3, 2 and 3. To find the rotation takes most of it, and it is the same
/// for all six.
/// corners, shape, material  as in load_deformed
/// places          [count] of its blocks
/// element_blocks  [18 per element]
WEFT_KERNEL(block_tetrahedra, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* shape, WEFT_GLOBAL const float* material,
            WEFT_GLOBAL const int* places, WEFT_GLOBAL float4* element_blocks, int count) {
    const real3 b1 = load3(shape, i, count, 0);
    const real3 b2 = load3(shape, i, count, 3);
    const real3 b3 = load3(shape, i, count, 6);
    const real3 b0 = scale(add(add(b1, b2), b3), splat(-1.0f));
    const tetrahedron t = load_deformed(positions, corners, shape, material, i, count);
    const tetrahedron_resistance r = resistance_of(t);
    const integer place = load_index(places, i);
    store_element_block(element_blocks, place, 0, tetrahedron_clamped(t, r, b0, b1));
    store_element_block(element_blocks, place, 1, tetrahedron_clamped(t, r, b0, b2));
    store_element_block(element_blocks, place, 2, tetrahedron_clamped(t, r, b0, b3));
    store_element_block(element_blocks, place, 3, tetrahedron_clamped(t, r, b1, b2));
    store_element_block(element_blocks, place, 4, tetrahedron_clamped(t, r, b1, b3));
    store_element_block(element_blocks, place, 5, tetrahedron_clamped(t, r, b2, b3));
}

WEFT_KERNELS_END

#endif
