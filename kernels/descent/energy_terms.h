#ifndef WEFT_KERNELS_DESCENT_ENERGY_TERMS_H
#define WEFT_KERNELS_DESCENT_ENERGY_TERMS_H

// E(x) as a sum that every device adds up in the same order: each element writes its term, 64
// columns of each strip's terms are added up, and what these give is left to whoever wants it. No
// term is negative (but of solids with a negative Poisson's ratio), so rounding is relative to E.
//
// slots  [items] where in `terms` an item's stands; items of one strip stand side by side

#include "kernels/columns.h"
#include "kernels/energies/hinge.h"
#include "kernels/energies/membrane.h"
#include "kernels/energies/spring.h"
#include "kernels/energies/tetrahedron.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

WEFT_KERNELS_BEGIN

WEFT_INLINE void store_term(WEFT_GLOBAL float* terms, WEFT_GLOBAL const int* slots, item i,
                            real term) {
    const item place = {slots[i.first], i.count};
    store(terms, place, term);
}

/// ends, material as in project_springs
WEFT_KERNEL(spring_terms, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* ends,
            WEFT_GLOBAL const float* material, WEFT_GLOBAL const int* slots,
            WEFT_GLOBAL float* terms, int spring_count) {
    const real3 x0 = xyz(gather4(positions, load_index(ends, i)));
    const real3 x1 = xyz(gather4(positions, load_index(ends, column(i, spring_count, 1))));
    const real stiffness = splat(1.0f) / load(material, column(i, spring_count, 1));
    store_term(terms, slots, i, spring_energy(x0, x1, load(material, i), stiffness));
}

/// corners, weights as in project_hinges
WEFT_KERNEL(hinge_terms, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* weights, WEFT_GLOBAL const int* slots,
            WEFT_GLOBAL float* terms, int hinge_count) {
    const real3 x0 = xyz(gather4(positions, load_index(corners, i)));
    const real3 x1 = xyz(gather4(positions, load_index(corners, column(i, hinge_count, 1))));
    const real3 x2 = xyz(gather4(positions, load_index(corners, column(i, hinge_count, 2))));
    const real3 x3 = xyz(gather4(positions, load_index(corners, column(i, hinge_count, 3))));
    const real3 bend = hinge_bend(x0, x1, x2, x3, load(weights, column(i, hinge_count, 1)),
                                  load(weights, column(i, hinge_count, 2)),
                                  load(weights, column(i, hinge_count, 3)));
    store_term(terms, slots, i, hinge_energy(bend));
}

/// corners, shape, material as in project_membranes
WEFT_KERNEL(membrane_terms, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* shape, WEFT_GLOBAL const float* material,
            WEFT_GLOBAL const int* slots, WEFT_GLOBAL float* terms, int count) {
    const real3 x0 = xyz(gather4(positions, load_index(corners, i)));
    const real3 x1 = xyz(gather4(positions, load_index(corners, column(i, count, 1))));
    const real3 x2 = xyz(gather4(positions, load_index(corners, column(i, count, 2))));
    const real2 b1 = make2(load(shape, i), load(shape, column(i, count, 1)));
    const real2 b2 = make2(load(shape, column(i, count, 2)), load(shape, column(i, count, 3)));
    const membrane m =
        make_membrane(x0, x1, x2, b1, b2, load(material, i), load(material, column(i, count, 1)));
    store_term(terms, slots, i, membrane_energy(m));
}

/// corners, shape, material as in project_tetrahedra
WEFT_KERNEL(tetrahedron_terms, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* corners,
            WEFT_GLOBAL const float* shape, WEFT_GLOBAL const float* material,
            WEFT_GLOBAL const int* slots, WEFT_GLOBAL float* terms, int count) {
    const real3 x0 = xyz(gather4(positions, load_index(corners, i)));
    const real3 x1 = xyz(gather4(positions, load_index(corners, column(i, count, 1))));
    const real3 x2 = xyz(gather4(positions, load_index(corners, column(i, count, 2))));
    const real3 x3 = xyz(gather4(positions, load_index(corners, column(i, count, 3))));
    const mat3 map = tetrahedron_map(x0, x1, x2, x3, load3(shape, i, count, 0),
                                     load3(shape, i, count, 3), load3(shape, i, count, 6));
    const tetrahedron t =
        make_tetrahedron(map, load(material, i), load(material, column(i, count, 1)));
    store_term(terms, slots, i, tetrahedron_energy(t));
}

/// m / (2 h^2) |x - x~|^2 of free vertices; inverse_h2 = 1 / h^2
WEFT_KERNEL(inertia_terms, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float4* targets,
            WEFT_GLOBAL const int* slots, WEFT_GLOBAL float* terms, float inverse_h2) {
    const real4 x = load4(positions, i);
    const real3 away = subtract(xyz(x), xyz(load4(targets, i)));
    const real inertia = inverse_h2 / (x.w > splat(0.0f) ? x.w : splat(1.0f));
    const real free = x.w > splat(0.0f) ? splat(0.5f) : splat(0.0f);
    store_term(terms, slots, i, free * inertia * dot3(away, away));
}

/// Adds up columns: sums[i] = terms[begin] + terms[begin + stride] + ..., `length` terms.
/// columns  [2 * items] begin, length; those of neighbouring items are neighbours
WEFT_KERNEL(add_terms, WEFT_GLOBAL const float* terms, WEFT_GLOBAL const int* columns,
            WEFT_GLOBAL float* sums, int stride) {
    real sum = splat(0.0f);
    const int length = columns[2 * i.first + 1];
    for (int k = 0; k < length; ++k) {
        const item place = {columns[2 * i.first] + stride * k, i.count};
        sum = sum + load(terms, place);
    }
    store(sums, i, sum);
}

WEFT_KERNELS_END

#endif
