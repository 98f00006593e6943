#ifndef WEFT_KERNELS_CONTACT_TERMS_H
#define WEFT_KERNELS_CONTACT_TERMS_H

// The energy of contacts, as they were found at the substep's begin. A contact has a row entry with
// each of its vertices, but one energy: it counts at the first of them that moves and has a weight.

#include "kernels/contact/rows.h"
#include "kernels/descent/energy_terms.h"

WEFT_KERNELS_BEGIN

/// The first of a contact's vertices that has an entry of it.
WEFT_INLINE whole owner_of(WEFT_GLOBAL const float4* positions, whole c0, whole c1, whole c2,
                           whole c3, real4 w) {
    const real zero = splat(0.0f);
    const mask has0 = both(w.x != zero, gather4(positions, address(c0)).w > zero);
    const mask has1 = both(w.y != zero, gather4(positions, address(c1)).w > zero);
    const mask has2 = both(w.z != zero, gather4(positions, address(c2)).w > zero);
    const whole later = has2 ? c2 : c3;
    const whole second = has1 ? c1 : later;
    return has0 ? c0 : second;
}

/// The energy of the contacts that count at each vertex [J].
/// points     [vertices] xyz: where the vertices are [m]
/// positions  [vertices] w = 1/mass [1/kg]
/// others as in gather_contacts (rows.h)
WEFT_INLINE real energy_of_contacts(WEFT_GLOBAL const float4* points,
                                    WEFT_GLOBAL const float4* positions,
                                    WEFT_GLOBAL const int* rows, WEFT_GLOBAL const int* counts,
                                    WEFT_GLOBAL const int* corner0, WEFT_GLOBAL const int* corner1,
                                    WEFT_GLOBAL const int* corner2, WEFT_GLOBAL const int* corner3,
                                    WEFT_GLOBAL const float4* normals,
                                    WEFT_GLOBAL const float4* weights,
                                    WEFT_GLOBAL const float4* measures, item i) {
    const whole vertex = item_numbers(i);
    const whole start = load_whole(rows, i);
    const whole count = load_whole(counts, i);
    const int longest = largest_whole(count);
    real sum = splat(0.0f);
    for (int k = 0; k < longest; ++k) {
        const mask on = splat_whole(k) < count;
        const integer entry = address(on ? start + splat_whole(WEFT_ROW_STRIDE * k) : start);
        const contact_entry c = load_contact(points, corner0, corner1, corner2, corner3, normals,
                                             weights, measures, entry);
        const whole owner = owner_of(positions, gather_whole(corner0, entry),
                                     gather_whole(corner1, entry), gather_whole(corner2, entry),
                                     gather_whole(corner3, entry), gather4(weights, entry));
        const real energy = contact_energy(c.gap, c.range, c.stiffness);
        sum = sum + (both(on, owner == vertex) ? energy : splat(0.0f));
    }
    return sum;
}

/// The contacts' terms of E(x); see descent/energy_terms.h. Over all vertices.
/// positions  [vertices] xyz [m], w = 1/mass [1/kg]
/// others as in gather_contacts
WEFT_NARROW_KERNEL(contact_terms, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const int* rows,
                   WEFT_GLOBAL const int* counts, WEFT_GLOBAL const int* corner0,
                   WEFT_GLOBAL const int* corner1, WEFT_GLOBAL const int* corner2,
                   WEFT_GLOBAL const int* corner3, WEFT_GLOBAL const float4* normals,
                   WEFT_GLOBAL const float4* weights, WEFT_GLOBAL const float4* measures,
                   WEFT_GLOBAL const int* slots, WEFT_GLOBAL float* terms) {
    store_term(terms, slots, i,
               energy_of_contacts(positions, positions, rows, counts, corner0, corner1, corner2,
                                  corner3, normals, weights, measures, i));
}

/// What contacts have stored where a frame begins, and where a substep ends. Over all vertices.
/// positions  [vertices] xyz [m], w = 1/mass [1/kg]
/// previous   [vertices] xyz: where they were at the substep's begin [m]
/// energies   [2 * vertices] written: at the begin of instance 0, and at the positions [J]
/// others as in gather_contacts
WEFT_NARROW_KERNEL(measure_contacts, WEFT_GLOBAL const float4* positions,
                   WEFT_GLOBAL const float4* previous, WEFT_GLOBAL const int* rows,
                   WEFT_GLOBAL const int* counts, WEFT_GLOBAL const int* corner0,
                   WEFT_GLOBAL const int* corner1, WEFT_GLOBAL const int* corner2,
                   WEFT_GLOBAL const int* corner3, WEFT_GLOBAL const float4* normals,
                   WEFT_GLOBAL const float4* weights, WEFT_GLOBAL const float4* measures,
                   WEFT_GLOBAL float* energies, int vertex_count, int instance) {
    if (instance == 0) {
        store(energies, i,
              energy_of_contacts(previous, positions, rows, counts, corner0, corner1, corner2,
                                 corner3, normals, weights, measures, i));
    }
    store(energies, column(i, vertex_count, 1),
          energy_of_contacts(positions, positions, rows, counts, corner0, corner1, corner2, corner3,
                             normals, weights, measures, i));
}

WEFT_KERNELS_END

#endif
