#ifndef WEFT_KERNELS_XPBD_TRIPLE_H
#define WEFT_KERNELS_XPBD_TRIPLE_H

#include "kernels/matrix.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

/// As solve_pair(), of three constraints: (G + A) d = -r, where G = grad C M^-1 grad C^T, A is the
/// diagonal matrix of the compliances `a`, divided by h^2, and r = C + A lambda. By elimination;
/// the pivots of G + A are not below A's, whatever the rounding of G's, so compliances may differ
/// by many orders of magnitude.
WEFT_INLINE real3 solve_triple(sym3 g, real3 a, real3 r) {
    const real zero = splat(0.0f);
    const real inverse_x = splat(1.0f) / (g.xx + a.x);
    const real l_yx = g.xy * inverse_x;
    const real l_zx = g.xz * inverse_x;
    const real inverse_y = splat(1.0f) / (larger(g.yy - l_yx * g.xy, zero) + a.y);
    const real yz = g.yz - l_yx * g.xz;
    const real l_zy = yz * inverse_y;
    const real pivot_z = larger(g.zz - l_zx * g.xz - l_zy * yz, zero) + a.z;
    const real y = r.y - l_yx * r.x;
    const real z = r.z - l_zx * r.x - l_zy * y;
    const real d_z = -z / pivot_z;
    const real d_y = -y * inverse_y - l_zy * d_z;
    const real d_x = -r.x * inverse_x - l_yx * d_y - l_zx * d_z;
    return make3(d_x, d_y, d_z);
}

WEFT_KERNELS_END

#endif
