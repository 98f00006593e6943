#ifndef WEFT_KERNELS_BODIES_FREE_BODIES_H
#define WEFT_KERNELS_BODIES_FREE_BODIES_H

// The momentum of bodies that nothing holds. At the minimum of E, internal forces and their torques
// add up to zero, so for each such body sum m (x - x~) = 0 and sum m r x (x - x~) = 0, with r from
// its centre of mass; after a few sweeps they are not, and what is missing brakes a stiff body's
// fall and its rotation like air. These kernels take it out, as one shift and one turn of the whole
// body: elements do not see it, and E falls by what that changes of the inertia.

#include "kernels/bodies/sliding.h"

WEFT_KERNELS_BEGIN

/// How a body has to move that lacks such a shift, besides what its moments say of turns. The angle
/// is the smaller the better its step is solved, and each round leaves of it about its square.
/// lack   a shift, and a torque [m^2]
/// share  of the pushes that is left out
WEFT_INLINE body_motion motion_against(moments m, holding h, body_motion lack, real share) {
    const sym6 form = own_form_of(m, h);
    const sym6 hold = form_of_holding(h);
    body_motion done = no_motion();
    for (int round = 0; round < 3; ++round) {
        const body_motion held = multiply_sym6(hold, done);
        const real3 left = subtract(subtract(lack.shift, done.shift), held.shift);
        const real3 torque = add_scaled(lag_of_turn(m, done.turn), m.torque, -share);
        const real3 turn = subtract(add(torque, lack.turn), held.turn);
        done = add_scaled_motion(done, solve_sym6(form, make_motion(left, turn)), splat(1.0f));
        done.turn = bounded_turn(done.turn);
    }
    return done;
}

typedef struct {
    body_motion motion;
    real slides;  ///< 1: friction does not hold the body; 0: it does, or there is none
} body_step;

/// How a body has to move that lacks so much where obstacles bear it.
WEFT_INLINE body_step missing_motion(moments m, borne_lag borne) {
    const real3 lift = scale(lift_of(borne.lag, m), is_held(m.hold));
    const body_motion lack = make_motion(subtract(borne.lag, lift), no_motion().turn);
    const body_motion held = motion_against(m, m.hold, lack, borne.share);
    const real3 kept = multiply_sym6(form_of_holding(m.hold), held).shift;
    const sliding may_be = sliding_of(m, borne, kept);
    const body_motion pulled = add_scaled_motion(lack, force_of_sliding(m, may_be), splat(1.0f));
    const body_motion slid = motion_against(m, no_holding(), pulled, borne.share);
    const sliding s = against_friction(may_be, slid);
    const body_motion done = if_it_slides(s, slid, held);
    const real is_turned = m.pushed > splat(0.0f) ? splat(0.0f) : splat(1.0f);
    const body_step step = {make_motion(add(done.shift, lift), scale(done.turn, is_turned)),
                            s.slides};
    return step;
}

/// How far the body of each run has to go.
/// sums       as in sum_of_runs
/// first_run  [runs] the first one of the same body
/// counts     [runs] of that body's runs
/// motions    [3 * (runs + 1)] column-major, written: the shift [m], the turn, and the centre [m],
///            w: whether it slides
/// most_runs  that a body has
WEFT_KERNEL(solve_runs, WEFT_GLOBAL const float4* sums, WEFT_GLOBAL const int* first_run,
            WEFT_GLOBAL const float* counts, WEFT_GLOBAL float4* motions, int most_runs,
            int run_count) {
    const moments m = sum_of_runs(sums, load_whole(first_run, i), load(counts, i), most_runs);
    const body_step missing = missing_motion(m, without_throw(m.lag, m, no_motion().shift));
    store_motion(motions, run_count + 1, i, missing.motion);
    store4(motions, column(i, run_count + 1, 2), with_w(m.centre, missing.slides));
}

/// Moves a vertex, and its velocity by as much per substep: to that nothing is lost by rounding,
/// whereas a way may be too small for a coordinate. Parameters as in move_runs.
/// slides  1: of a body that friction lets go, so that it does not bring the vertex back; else 0
WEFT_INLINE void shift_vertex(WEFT_GLOBAL float4* positions, WEFT_GLOBAL float4* deviations,
                              WEFT_GLOBAL float4* velocities, item i, real3 way, real slides,
                              float inverse_h) {
    const real4 x = load4(positions, i);
    const real4 deviation = load4(deviations, i);
    const real4 v = load4(velocities, i);
    store4(positions, i, with_w(add(xyz(x), way), x.w));
    const real loose = smaller(deviation.w, splat(WEFT_NO_GRIP));
    const real grip = slides > splat(0.0f) ? loose : deviation.w;
    store4(deviations, i, with_w(add(xyz(deviation), way), grip));
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
    const real4 centre = gather4(motions + 2 * (run_count + 1), run);
    const real3 lever = subtract(xyz(load4(positions, i)), xyz(centre));
    const real3 way = way_of_motion(gather_motion(motions, run_count + 1, run), lever);
    shift_vertex(positions, deviations, velocities, i, way, centre.w, inverse_h);
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
