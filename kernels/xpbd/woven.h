#ifndef WEFT_KERNELS_XPBD_WOVEN_H
#define WEFT_KERNELS_XPBD_WOVEN_H

#include "kernels/energies/woven.h"
#include "kernels/triangles.h"
#include "kernels/xpbd/triple.h"

WEFT_KERNELS_BEGIN

/// Projects triangles of woven cloth (kernels/energies/woven.h) as three XPBD constraints at once:
/// |f_u| - 1, |f_v| - 1 and f_u . f_v, with compliances 1/k_u, 1/k_v and 1/k_s.
///
/// positions    [vertices] xyz [m], w = 1/mass [1/kg]; read and written
/// corners      [3 * count] column-major
/// shape        [4 * count] column-major: b_1, b_2 [1/m], u along the warp
/// material     [3 * count] column-major: warp, weft, shear stiffness, times the rest area [J]
/// of_warp, of_weft, of_shear  [count] multipliers; taken as 0 where `fresh`
/// inverse_h2   1 / h^2 [1/s^2], h the substep
/// fresh        1 in the first iteration of a substep, else 0
/// Triangles of one call share no vertex.
WEFT_KERNEL(project_woven, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* shape, WEFT_GLOBAL const float* material,
            WEFT_GLOBAL float* of_warp, WEFT_GLOBAL float* of_weft, WEFT_GLOBAL float* of_shear,
            int count, float inverse_h2, int fresh) {
    integer vertex[3];
    real4 x[3];
    for (int k = 0; k < 3; ++k) {
        vertex[k] = load_index(corners, column(i, count, k));
        x[k] = gather4(positions, vertex[k]);
    }
    const triangle_shape t = load_triangle_shape(shape, i, count);
    const woven w =
        make_woven(xyz(x[0]), xyz(x[1]), xyz(x[2]), t.b[1], t.b[2], load(material, i),
                   load(material, column(i, count, 1)), load(material, column(i, count, 2)));
    const real3 compliance = make3(inverse_h2 / w.warp.stiffness, inverse_h2 / w.weft.stiffness,
                                   inverse_h2 / w.shear_stiffness);
    real3 multiplier = make3(splat(0.0f), splat(0.0f), splat(0.0f));
    if (!fresh) multiplier = make3(load(of_warp, i), load(of_weft, i), load(of_shear, i));

    sym3 mobility = diagonal_sym(splat(0.0f));
    for (int k = 0; k < 3; ++k) {
        const real3 warp = scale(w.warp.direction, t.b[k].u);
        const real3 weft = scale(w.weft.direction, t.b[k].v);
        const real3 shear = woven_shearing(w, t.b[k]);
        const sym3 products = make_sym(dot3(warp, warp), dot3(warp, weft), dot3(warp, shear),
                                       dot3(weft, weft), dot3(weft, shear), dot3(shear, shear));
        mobility = add_sym(mobility, scale_sym(products, x[k].w));
    }
    const real3 residual =
        make3(w.warp.strain + compliance.x * multiplier.x,
              w.weft.strain + compliance.y * multiplier.y, w.shear + compliance.z * multiplier.z);
    const real3 change = solve_triple(mobility, compliance, residual);

    store(of_warp, i, multiplier.x + change.x);
    store(of_weft, i, multiplier.y + change.y);
    store(of_shear, i, multiplier.z + change.z);
    for (int k = 0; k < 3; ++k) {
        const real3 threads = add_scaled(scale(w.warp.direction, t.b[k].u * change.x),
                                         w.weft.direction, t.b[k].v * change.y);
        const real3 push = add_scaled(threads, woven_shearing(w, t.b[k]), change.z);
        scatter4(positions, vertex[k], with_w(add_scaled(xyz(x[k]), push, x[k].w), x[k].w));
    }
}

WEFT_KERNELS_END

#endif
