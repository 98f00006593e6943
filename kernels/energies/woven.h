#ifndef WEFT_KERNELS_ENERGIES_WOVEN_H
#define WEFT_KERNELS_ENERGIES_WOVEN_H

// A triangle of woven cloth: its warp and weft threads resist stretch, and the angle between them
// resists shear, each with a stiffness of its own (Baraff and Witkin 1998, "Large steps in cloth
// simulation", section 4). At rest u lies along the warp and v along the weft, so the columns f_u
// and f_v of F (3x2) are the images of the threads:
//   E = k_u/2 (|f_u| - 1)^2 + k_v/2 (|f_v| - 1)^2 + k_s/2 (f_u . f_v)^2
// k_u and k_v are forces per width and strain, k_s is the shear modulus times the thickness [N/m];
// here they are multiplied by the rest area [J]. A pull along the threads does not narrow the cloth
// across them. Pulled along the bias, between equal threads, by p per width, to a and b times its
// length and width: with q = p / (2 a) and s = 1 / (1 - q / k_u),
//   a^2 = s^2 + q / k_s        b^2 = s^2 - q / k_s
//
// With n = f / |f|, c = f_u . f_v, and g_j = b_ju f_v + b_jv f_u = dc/dx_j:
//   dE/dx_j = k_u (|f_u| - 1) b_ju n_u + k_v (|f_v| - 1) b_jv n_v + k_s c g_j
//   d2E/dx_jdx_k = b_ju b_ku T_u + b_jv b_kv T_v + k_s g_j g_k^T
//                  + k_s c (b_ju b_kv + b_jv b_ku) I
//   T = k n n^T + k (1 - 1/|f|) (I - n n^T)
// Two parts of it are indefinite. For the projected blocks, the second one of T is left out where a
// thread is compressed, as with springs; and of the matrix ((0, c), (c, 0)) of the last part
// remains |c|/2 ((1, s), (s, 1)), s the sign of c, which is the part of its positive eigenvalue. So
// the blocks of all corners together are positive semi-definite, and no less stiff than the exact
// ones. A thread without length has no direction: n = 0 then.

#include "kernels/energies/triangle.h"
#include "kernels/matrix.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// One of the two threads
typedef struct {
    real3 image;      ///< f
    real3 direction;  ///< n
    real strain;      ///< |f| - 1
    real inverse;     ///< 1 / |f|
    real stiffness;   ///< k times the rest area [J]
} thread;

WEFT_INLINE thread make_thread(real3 image, real stiffness) {
    const real length = length3(image);
    thread t;
    t.image = image;
    t.inverse = splat(1.0f) / divisor(length);
    t.direction = scale(image, t.inverse);
    t.strain = length - splat(1.0f);
    t.stiffness = stiffness;
    return t;
}

/// A triangle as it is deformed.
typedef struct {
    thread warp, weft;
    real shear;            ///< c
    real shear_stiffness;  ///< k_s times the rest area [J]
} woven;

/// For corners x_j [m]
WEFT_INLINE woven make_woven(real3 x0, real3 x1, real3 x2, real2 b1, real2 b2, real warp, real weft,
                             real shear) {
    const real3 e1 = subtract(x1, x0);
    const real3 e2 = subtract(x2, x0);
    woven w;
    w.warp = make_thread(add_scaled(scale(e1, b1.u), e2, b2.u), warp);
    w.weft = make_thread(add_scaled(scale(e1, b1.v), e2, b2.v), weft);
    w.shear = dot3(w.warp.image, w.weft.image);
    w.shear_stiffness = shear;
    return w;
}

WEFT_INLINE real thread_energy(thread t) { return splat(0.5f) * t.stiffness * t.strain * t.strain; }

/// [J]
WEFT_INLINE real woven_energy(woven w) {
    const real shear = splat(0.5f) * w.shear_stiffness * w.shear * w.shear;
    return thread_energy(w.warp) + thread_energy(w.weft) + shear;
}

/// dc/dx_j [1/m]
WEFT_INLINE real3 woven_shearing(woven w, real2 b) {
    return add_scaled(scale(w.weft.image, b.u), w.warp.image, b.v);
}

/// dE/dx_j [N] of the corner with shape gradient b
WEFT_INLINE real3 woven_gradient(woven w, real2 b) {
    const real warp = w.warp.stiffness * w.warp.strain * b.u;
    const real weft = w.weft.stiffness * w.weft.strain * b.v;
    const real3 threads = add_scaled(scale(w.warp.direction, warp), w.weft.direction, weft);
    return add_scaled(threads, woven_shearing(w, b), w.shear_stiffness * w.shear);
}

/// across (I - n n^T) of T, projected
WEFT_INLINE real thread_across(thread t) {
    return t.stiffness * larger(splat(1.0f) - t.inverse, splat(0.0f));
}

/// What the shear's part in I takes of b, projected: |c|/2 (b_ju + s b_jv)(b_ku + s b_kv)
WEFT_INLINE real woven_lean(woven w, real2 b) {
    return w.shear < splat(0.0f) ? b.u - b.v : b.u + b.v;
}
WEFT_INLINE real woven_turning(woven w) {
    return splat(0.5f) * w.shear_stiffness * larger(w.shear, -w.shear);
}

/// d2E/dx_jdx_j [N/m] of the corner with shape gradient b, projected to positive semi-definite
WEFT_INLINE sym3 woven_hessian(woven w, real2 b) {
    const real uu = b.u * b.u;
    const real vv = b.v * b.v;
    const real across_u = thread_across(w.warp);
    const real across_v = thread_across(w.weft);
    const real lean = woven_lean(w, b);
    const sym3 threads = add_sym(outer_sym(w.warp.direction, (w.warp.stiffness - across_u) * uu),
                                 outer_sym(w.weft.direction, (w.weft.stiffness - across_v) * vv));
    const sym3 shear = outer_sym(woven_shearing(w, b), w.shear_stiffness);
    return add_diagonal(add_sym(threads, shear),
                        across_u * uu + across_v * vv + woven_turning(w) * lean * lean);
}

/// The common form of all blocks: along and across the threads, the shear's g, and a part in I
WEFT_INLINE mat3 woven_block_of(woven w, real2 b_j, real2 b_k, real across_u, real across_v,
                                real turning) {
    const real uu = b_j.u * b_k.u;
    const real vv = b_j.v * b_k.v;
    const mat3 warp =
        outer_mat(w.warp.direction, scale(w.warp.direction, (w.warp.stiffness - across_u) * uu));
    const mat3 weft =
        outer_mat(w.weft.direction, scale(w.weft.direction, (w.weft.stiffness - across_v) * vv));
    const mat3 shear =
        outer_mat(woven_shearing(w, b_j), scale(woven_shearing(w, b_k), w.shear_stiffness));
    return add_diagonal_mat(add_mat(add_mat(warp, weft), shear),
                            across_u * uu + across_v * vv + turning);
}

/// Of corners with shape gradients b_j and b_k [N/m], projected like woven_hessian(), so that the
/// blocks of all corners together are positive semi-definite.
WEFT_INLINE mat3 woven_coupling(woven w, real2 b_j, real2 b_k) {
    return woven_block_of(w, b_j, b_k, thread_across(w.warp), thread_across(w.weft),
                          woven_turning(w) * woven_lean(w, b_j) * woven_lean(w, b_k));
}

/// d2E/dx_jdx_k [N/m], of corners with shape gradients b_j and b_k; the exact one
WEFT_INLINE mat3 woven_block(woven w, real2 b_j, real2 b_k) {
    const real one = splat(1.0f);
    return woven_block_of(w, b_j, b_k, w.warp.stiffness * (one - w.warp.inverse),
                          w.weft.stiffness * (one - w.weft.inverse),
                          w.shear_stiffness * w.shear * (b_j.u * b_k.v + b_j.v * b_k.u));
}

WEFT_KERNELS_END

#endif
