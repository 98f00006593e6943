#ifndef WEFT_KERNELS_DESCENT_TETRAHEDRA_H
#define WEFT_KERNELS_DESCENT_TETRAHEDRA_H

#include "kernels/columns.h"
#include "kernels/descent/energy_terms.h"
#include "kernels/descent/rows.h"
#include "kernels/energies/tetrahedron.h"
#include "kernels/tetrahedra.h"

WEFT_KERNELS_BEGIN

/// An entry of a vertex' row.
typedef struct {
    tetrahedron element;
    real3 own;  ///< b of the vertex [1/m]
} tetrahedron_entry;

/// x  the vertex [m]; the tables as in gather_tetrahedra
WEFT_INLINE tetrahedron_entry load_tetrahedron(WEFT_GLOBAL const float4* positions,
                                               WEFT_GLOBAL const int* others,
                                               WEFT_GLOBAL const float* shape,
                                               WEFT_GLOBAL const float* material, real3 x,
                                               item entry, int entry_count) {
    const real3 x1 = xyz(gather4(positions, load_index(others, entry)));
    const real3 x2 = xyz(gather4(positions, load_index(others, column(entry, entry_count, 1))));
    const real3 x3 = xyz(gather4(positions, load_index(others, column(entry, entry_count, 2))));
    const real3 b1 = load3(shape, entry, entry_count, 0);
    const real3 b2 = load3(shape, entry, entry_count, 3);
    const real3 b3 = load3(shape, entry, entry_count, 6);
    tetrahedron_entry e;
    e.element = make_tetrahedron(tetrahedron_map(x, x1, x2, x3, b1, b2, b3), load(material, entry),
                                 load(material, column(entry, entry_count, 1)));
    e.own = scale(add(add(b1, b2), b3), splat(-1.0f));
    return e;
}

/// Adds the tetrahedra's part of each vertex' gradient and Hessian block. Parameters as in
/// gather_springs, and
///
/// others    [3 * entries] column-major: the tetrahedron's other vertices
/// shape     [9 * entries] column-major: their b [1/m]; the vertex' own balances them
/// material  [2 * entries] column-major: mu, lambda, times the rest volume [J]
WEFT_KERNEL(gather_tetrahedra, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* vertices,
            WEFT_GLOBAL const int* slices, WEFT_GLOBAL const int* others,
            WEFT_GLOBAL const float* shape, WEFT_GLOBAL const float* material,
            WEFT_GLOBAL float* sums, int item_count, int entry_count, int stride, int fresh) {
    derivatives s = fresh ? zero_derivatives() : load_derivatives(sums, i, item_count);
    const real3 x = xyz(gather4(positions, load_index(vertices, i)));
    const int length = row_length(slices, i);
    for (int k = 0; k < length; ++k) {
        const item entry = row_entry(slices, i, stride, k);
        const tetrahedron_entry e =
            load_tetrahedron(positions, others, shape, material, x, entry, entry_count);
        s.gradient = add(s.gradient, tetrahedron_gradient(e.element, e.own));
        s.hessian = add_sym(s.hessian, tetrahedron_hessian(e.element, e.own));
    }
    store_derivatives(sums, i, item_count, s);
}

/// Only the gradients: the Hessian columns of the sums are left as they are.
WEFT_KERNEL(gather_tetrahedra_gradients, WEFT_GLOBAL const float4* positions,
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
        const tetrahedron_entry e =
            load_tetrahedron(positions, others, shape, material, x, entry, entry_count);
        gradient = add(gradient, tetrahedron_gradient(e.element, e.own));
    }
    store_gradient(sums, i, item_count, gradient);
}

/// Each tetrahedron's energy. corners, shape, material as in project_tetrahedra
WEFT_KERNEL(tetrahedron_terms, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* shape, WEFT_GLOBAL const float* material,
            WEFT_GLOBAL const int* slots, WEFT_GLOBAL float* terms, int count) {
    const tetrahedron t = load_deformed(positions, corners, shape, material, i, count);
    store_term(terms, slots, i, tetrahedron_energy(t));
}

WEFT_KERNELS_END

#endif
