#pragma once

#include "simulation/solver/solver.h"

namespace weft {

/// Newton's method on E(x), inexactly: each iteration makes the projected Hessian anew, solves for
/// a step by a fixed number of preconditioned conjugate gradients (conjugate_gradients.h), takes
/// it, and smooths what it left of short waves by sweeps of vertex block descent. For materials
/// that are stiff against inertia.
///
/// A substep: predict and a check, then `iterations` times
///   linearise, correct, product, advance, correct, product, advance ...
///   move, sweeps over seams and strips, and a check as JPGD's: where E rose, back, and the next
///   step is shorter (kernels/newton/control.h)
/// Then a last sweep, so that something is left even where every iteration was taken back, the
/// momentum of free bodies, where there are any, and velocities. The coarse space is made anew in
/// every fifth iteration. The first iterations take fewer steps than the later ones: where little
/// is to be gained, so they cost little. Obstacles push at the end of a move and of a sweep.
std::unique_ptr<Solver> make_newton_solver(Model& model);

}  // namespace weft
