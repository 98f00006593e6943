#ifndef WEFT_KERNELS_SOSD_SPRINGS_H
#define WEFT_KERNELS_SOSD_SPRINGS_H

#include "kernels/energies/spring.h"
#include "kernels/sosd/stencil.h"

WEFT_KERNELS_BEGIN

/// Moves the two vertices of each stencil, a spring, to the minimum of their common quadratic model
/// of E while all others stand still. With K the spring's block:
///   [ D0  -K ] [dx0]   [f0]
///   [ -K  D1 ] [dx1] = [f1]     by elimination of dx0; D0 and D1 contain K, so it is definite
/// material  [2 * stencils] column-major: rest length [m], stiffness [N/m]
/// For the others see stencil.h.
WEFT_KERNEL(solve_spring_stencils, WEFT_GLOBAL float4* positions, WEFT_GLOBAL const float4* targets,
            WEFT_GLOBAL const int* vertices, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* material, WEFT_GLOBAL const float* sums, int stencil_count,
            int item_count, float inverse_h2) {
    const vertex_system a =
        load_system(positions, targets, vertices, sums, corner_items(corners, i, stencil_count, 0),
                    item_count, inverse_h2);
    const vertex_system b =
        load_system(positions, targets, vertices, sums, corner_items(corners, i, stencil_count, 1),
                    item_count, inverse_h2);
    // What held vertices do not do couples to nothing.
    const sym3 k = scale_sym(spring_hessian(xyz(a.x), xyz(b.x), load(material, i),
                                            load(material, column(i, stencil_count, 1))),
                             a.free * b.free);

    // The columns of D0^-1 K, and the Schur complement D1 - K D0^-1 K.
    const sym3_factors factors = factor_sym(a.stiffness);
    const real3 u = solve_factored(factors, make3(k.xx, k.xy, k.xz));
    const real3 v = solve_factored(factors, make3(k.xy, k.yy, k.yz));
    const real3 w = solve_factored(factors, make3(k.xz, k.yz, k.zz));
    const real3 ku = multiply_sym(k, u);
    const real3 kv = multiply_sym(k, v);
    const real3 kw = multiply_sym(k, w);
    const sym3 left = add_sym(b.stiffness, make_sym(-ku.x, -ku.y, -ku.z, -kv.y, -kv.z, -kw.z));
    const real3 alone = solve_factored(factors, a.force);
    // What is left is a difference, rounded as what it is one of.
    const real least = larger(trace_sym(b.stiffness) * splat(1e-6f), splat(1e-30f));
    const real3 step_b =
        solve_factored(factor_sym_above(left, least), add(b.force, multiply_sym(k, alone)));
    const real3 carried = add(add(scale(u, step_b.x), scale(v, step_b.y)), scale(w, step_b.z));

    move_vertex(positions, a, add(alone, carried));
    move_vertex(positions, b, step_b);
}

WEFT_KERNELS_END

#endif
