#pragma once

#include "simulation/solver/solver.h"

namespace weft {

/// Jacobi-preconditioned gradient descent with Chebyshev acceleration (Wang and Yang 2016), with
/// the vertices' 3x3 Hessian blocks as the preconditioner.
///
/// A substep: predict, then `iterations` times one step of all vertices at once, from one buffer of
/// positions to another. Before every 8th step and behind the last one a check: the energy is added
/// up, one item decides, and all vertices keep their state or go back to the one that was kept
/// last. The Hessian blocks are made anew in every 32nd step. Then velocities.
///
/// Where it differs from the paper: the step size and Chebyshev's radius are limited so that few
/// iterations per substep cannot feed oscillations; a substep starts as in all descent methods here
/// (see kernels/descent/substep.h), and ends with a check. Obstacles push at the end of each step;
/// where there are any, the energy may rise to twice its lowest value before a step counts as bad.
std::unique_ptr<Solver> make_jpgd_solver(Model& model);

}  // namespace weft
