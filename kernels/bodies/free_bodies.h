#ifndef WEFT_KERNELS_BODIES_FREE_BODIES_H
#define WEFT_KERNELS_BODIES_FREE_BODIES_H

// The momentum of bodies that nothing holds. At the minimum of E, internal forces and their torques
// add up to zero, so for each such body sum m (x - x~) = 0 and sum m r x (x - x~) = 0, with r from
// its centre of mass; after a few sweeps they are not, and what is missing brakes a stiff body's
// fall and its rotation like air. These kernels take it out, as one shift and one turn of the whole
// body: elements do not see it, and E falls by what that changes of the inertia.

#include "kernels/bodies/moments.h"

WEFT_KERNELS_BEGIN

/// What is left of a shift that a spring of so many inertias holds.
WEFT_INLINE real part_led(real hold) { return splat(1.0f) / (splat(1.0f) + hold); }

/// How a body has to move that lacks so much where obstacles bear it, besides what its moments say
/// of turns. The angle is the smaller the better its step is solved, and each round leaves of it
/// about its square. What obstacles push is not turned: what hangs from what it drapes over would
/// turn it.
/// held  how hard obstacles hold what they have pushed, in units of its inertia: it stays where its
///       own friction and the obstacle keep it, and its elements hold what goes on
WEFT_INLINE body_motion missing_motion(moments m, borne_lag borne, float held) {
    const sym6 form = own_form_of(m);
    body_motion done = no_motion();
    for (int round = 0; round < 3; ++round) {
        const real3 left = subtract(borne.lag, done.shift);
        const real3 torque = add_scaled(lag_of_turn(m, done.turn), m.torque, -borne.share);
        done = add_scaled_motion(done, solve_sym6(form, make_motion(left, torque)), splat(1.0f));
        done.turn = bounded_turn(done.turn);
    }
    const real is_turned = m.pushed > splat(0.0f) ? splat(0.0f) : splat(1.0f);
    const real led = part_led(m.pushed * splat(held));
    return make_motion(scale(done.shift, led), scale(done.turn, is_turned));
}

/// How far the body of each run has to go.
/// sums       as in sum_of_runs
/// first_run  [runs] the first one of the same body
/// counts     [runs] of that body's runs
/// motions    [3 * (runs + 1)] column-major, written: the shift [m], the turn, and the centre [m]
/// most_runs  that a body has
/// held       as in missing_motion
WEFT_KERNEL(solve_runs, WEFT_GLOBAL const float4* sums, WEFT_GLOBAL const int* first_run,
            WEFT_GLOBAL const float* counts, WEFT_GLOBAL float4* motions, int most_runs,
            int run_count, float held) {
    const moments m = sum_of_runs(sums, load_whole(first_run, i), load(counts, i), most_runs);
    const borne_lag borne = without_throw(m.lag, m, no_motion().shift);
    store_motion(motions, run_count + 1, i, missing_motion(m, borne, held));
    store4(motions, column(i, run_count + 1, 2), with_w(m.centre, splat(0.0f)));
}

/// Moves a vertex, and its velocity by as much per substep: to that nothing is lost by rounding,
/// whereas a way may be too small for a coordinate. Parameters as in move_runs.
WEFT_INLINE void shift_vertex(WEFT_GLOBAL float4* positions, WEFT_GLOBAL float4* deviations,
                              WEFT_GLOBAL float4* velocities, item i, real3 way, float inverse_h) {
    const real4 x = load4(positions, i);
    const real4 deviation = load4(deviations, i);
    const real4 v = load4(velocities, i);
    store4(positions, i, with_w(add(xyz(x), way), x.w));
    store4(deviations, i, with_w(add(xyz(deviation), way), deviation.w));
    store4(velocities, i, with_w(add_scaled(xyz(v), way, v.w * splat(inverse_h)), v.w));
}

/// Moves the vertices of free bodies.
/// positions   [vertices] xyz [m]
/// deviations  [vertices] xyz: x - x~ [m], w: the grip (obstacles/grip.h) [m]
/// velocities  [vertices] xyz [m/s], w = what damping leaves per substep
/// motions     [3 * (runs + 1)] as solve_runs leaves them; the last one is zero
/// runs        [vertices] the run of each vertex; the last one for those that something holds
/// inverse_h   1 / h [1/s], h the substep
WEFT_KERNEL(move_runs, WEFT_GLOBAL float4* positions, WEFT_GLOBAL float4* deviations,
            WEFT_GLOBAL float4* velocities, WEFT_GLOBAL const float4* motions,
            WEFT_GLOBAL const int* runs, float inverse_h, int run_count) {
    const integer run = load_index(runs, i);
    const real3 centre = xyz(gather4(motions + 2 * (run_count + 1), run));
    const real3 lever = subtract(xyz(load4(positions, i)), centre);
    const real3 way = way_of_motion(gather_motion(motions, run_count + 1, run), lever);
    shift_vertex(positions, deviations, velocities, i, way, inverse_h);
}

/// Adds what obstacles pushed to the velocities.
/// positions   [vertices] xyz behind the pushes [m]
/// pushed      [vertices] xyz before them
/// velocities  [vertices] xyz [m/s], w = what damping leaves per substep
WEFT_KERNEL(push_velocities, WEFT_GLOBAL const float4* positions, WEFT_GLOBAL const float4* pushed,
            WEFT_GLOBAL float4* velocities, float inverse_h) {
    const real3 push = subtract(xyz(load4(positions, i)), xyz(load4(pushed, i)));
    const real4 v = load4(velocities, i);
    store4(velocities, i, with_w(add_scaled(xyz(v), push, v.w * splat(inverse_h)), v.w));
}

WEFT_KERNELS_END

#endif
