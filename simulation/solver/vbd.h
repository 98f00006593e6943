#pragma once

#include "simulation/solver/solver.h"

namespace weft {

/// Vertex block descent (Chen et al. 2024): sweeps (sweeps.h) in which each vertex solves its own
/// 3x3 system while all others stand still.
///
/// Where it differs from the paper: the start of a substep (kernels/descent/substep.h), obstacles,
/// which push at the end of a sweep, and no Chebyshev acceleration.
std::unique_ptr<Solver> make_vbd_solver(Model& model);

}  // namespace weft
