#ifndef WEFT_KERNELS_JPGD_CONTACTS_H
#define WEFT_KERNELS_JPGD_CONTACTS_H

// Steps of vertices that may have contacts. Which of these push changes from step to step, and what
// is extrapolated beyond a step goes back into them: so vertices with contacts take theirs as they
// are, and so do those that are taken back by truncation (Gaia does the same with Chebyshev's
// acceleration of VBD).
//
// A part alpha of a step by a vertex' block lowers the elements' energy, as their Hessians are not
// larger than 1/alpha times their blocks (control.h). Contacts have blocks that are a bound
// already, however their corners move at once (contact/rows.h), and inertia knows no other
// vertices. So the whole of a step by
//
//   P = M/h^2 + H/alpha + contacts
//
// does the same, and leads three times as far where contacts press: after 8 iterations of 1.7 ms
// the error is 0.09 where it was 0.15 (pillows.toml, frame 30), 0.008 and 0.028 (letters.toml).

#include "kernels/jpgd/step.h"
#include "kernels/lanes.h"

WEFT_KERNELS_BEGIN

/// Makes a bound of the elements' blocks, before contacts add theirs.
/// sums  [9 * vertices] from H to H/alpha
WEFT_KERNEL(bound_elements, WEFT_GLOBAL float* sums, WEFT_GLOBAL const float* control,
            int vertex_count) {
    const float size = control[WEFT_STEP_SIZE];
    derivatives s = load_derivatives(sums, i, vertex_count);
    s.hessian = scale_sym(s.hessian, splat(size > 0.0f ? 1.0f / size : 1.0f));
    store_derivatives(sums, i, vertex_count, s);
}

/// As step_preconditioned, by the sum of bounds.
/// counts  [vertices] how many contacts each has
WEFT_KERNEL(step_beside_contacts, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL float4* next,
            WEFT_GLOBAL const float4* residue, WEFT_GLOBAL float4* next_residue,
            WEFT_GLOBAL const float4* targets, WEFT_GLOBAL const float* sums,
            WEFT_GLOBAL const float* control, WEFT_GLOBAL const float* weights,
            WEFT_GLOBAL const int* counts, int vertex_count, float inverse_h2, int iteration) {
    const real4 x = load4(positions, i);
    const real accelerated = load_whole(counts, i) > splat_whole(0) ? splat(0.0f) : splat(1.0f);
    const float size = control[WEFT_STEP_SIZE] > 0.0f ? 1.0f : 0.0f;
    const real3 move =
        preconditioned_move(positions, next, residue, next_residue, targets, sums, control, weights,
                            vertex_count, inverse_h2, iteration, size, accelerated, i);
    const real3 sum = add(xyz(x), move);
    const real3 lost = scale(subtract(move, subtract(sum, xyz(x))), accelerated);
    store4(next, i, with_w(sum, x.w));
    store4(next_residue, i, with_w(lost, splat(0.0f)));
}

/// What rounding took from a vertex that was taken back is of another place.
/// cut      [vertices] 0: it was not
/// residue  [vertices]
WEFT_KERNEL(drop_residues, WEFT_GLOBAL const int* cut, WEFT_GLOBAL float4* residue) {
    const real zero = splat(0.0f);
    const real4 none = {zero, zero, zero, zero};
    store4_where(load_whole(cut, i) > splat_whole(0), residue, i, none);
}

WEFT_KERNELS_END

#endif
