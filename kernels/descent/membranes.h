#ifndef WEFT_KERNELS_DESCENT_MEMBRANES_H
#define WEFT_KERNELS_DESCENT_MEMBRANES_H

#include "kernels/descent/energy_terms.h"
#include "kernels/descent/rows.h"
#include "kernels/descent/triangle_rows.h"
#include "kernels/energies/membrane.h"

WEFT_KERNELS_BEGIN

WEFT_INLINE membrane membrane_of(triangle_entry t, WEFT_GLOBAL const float* material, real3 x,
                                 item entry, int entry_count) {
    return make_membrane(x, t.x1, t.x2, t.shape.b[1], t.shape.b[2], load(material, entry),
                         load(material, column(entry, entry_count, 1)));
}

/// Adds the membranes' part of each vertex' gradient and Hessian block. Parameters as in
/// gather_springs, and
///
/// others, shape  as in load_triangle()
/// material       [2 * entries] column-major: mu, lambda, times the rest area [J]
WEFT_KERNEL(gather_membranes, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* vertices,
            WEFT_GLOBAL const int* slices, WEFT_GLOBAL const int* others,
            WEFT_GLOBAL const float* shape, WEFT_GLOBAL const float* material,
            WEFT_GLOBAL float* sums, int item_count, int entry_count, int stride, int fresh) {
    derivatives s = fresh ? zero_derivatives() : load_derivatives(sums, i, item_count);
    const real3 x = xyz(gather4(positions, load_index(vertices, i)));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const triangle_entry t = load_triangle(positions, others, shape, entry, entry_count);
        const membrane m = membrane_of(t, material, x, entry, entry_count);
        s.gradient = add(s.gradient, membrane_gradient(m, t.shape.b[0]));
        s.hessian = add_sym(s.hessian, membrane_hessian(m, t.shape.b[0]));
    }
    store_derivatives(sums, i, item_count, s);
}

/// Only the gradients: the Hessian columns of the sums are left as they are.
WEFT_KERNEL(gather_membrane_gradients, WEFT_GLOBAL const float4* positions,
            WEFT_GLOBAL const int* vertices, WEFT_GLOBAL const int* slices,
            WEFT_GLOBAL const int* others, WEFT_GLOBAL const float* shape,
            WEFT_GLOBAL const float* material, WEFT_GLOBAL float* sums, int item_count,
            int entry_count, int stride, int fresh) {
    real3 gradient = make3(splat(0.0f), splat(0.0f), splat(0.0f));
    if (!fresh) gradient = load_gradient(sums, i, item_count);
    const real3 x = xyz(gather4(positions, load_index(vertices, i)));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const triangle_entry t = load_triangle(positions, others, shape, entry, entry_count);
        const membrane m = membrane_of(t, material, x, entry, entry_count);
        gradient = add(gradient, membrane_gradient(m, t.shape.b[0]));
    }
    store_gradient(sums, i, item_count, gradient);
}

/// Each triangle's energy. corners, shape, material as in project_membranes
WEFT_KERNEL(membrane_terms, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* shape, WEFT_GLOBAL const float* material,
            WEFT_GLOBAL const int* slots, WEFT_GLOBAL float* terms, int count) {
    const real3 x0 = xyz(gather4(positions, load_index(corners, i)));
    const real3 x1 = xyz(gather4(positions, load_index(corners, column(i, count, 1))));
    const real3 x2 = xyz(gather4(positions, load_index(corners, column(i, count, 2))));
    const triangle_shape t = load_triangle_shape(shape, i, count);
    const membrane m = make_membrane(x0, x1, x2, t.b[1], t.b[2], load(material, i),
                                     load(material, column(i, count, 1)));
    store_term(terms, slots, i, membrane_energy(m));
}

WEFT_KERNELS_END

#endif
