#pragma once

#include "simulation/solver/solver.h"

namespace weft {

/// Vertex block descent (Chen et al. 2024) on strips and seams.
///
/// A substep: predict, then `iterations` times
///   seams:  all vertices with elements between two strips, colour by colour: the elements add up
///           gradient and Hessian of each vertex, then each solves its 3x3 system
///   strips: all vertices inside a strip likewise, then obstacles (all vertices), as in XPBD: an
///           iteration ends without penetration, and friction sees the whole iteration's slip
/// then velocities. This order is the same for every number of devices: it defines the result.
std::unique_ptr<Solver> make_vbd_solver(Model& model);

}  // namespace weft
