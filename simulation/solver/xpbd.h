#pragma once

#include "simulation/solver/solver.h"

namespace weft {

/// Extended position based dynamics (Macklin, Mueller and Chentanez 2016) on strips and seams.
///
/// A substep: predict, then `iterations` times
///   seams:  all elements between two strips, family by family, each colour by colour
///   strips: all elements inside a strip likewise, then obstacles, so that an iteration ends
///           without penetration
/// then velocities. This order is the same for every number of devices: it defines the result.
enum class XpbdTasks {
    kWhole,     ///< a task does all families
    kByFamily,  ///< one, or the obstacles; the result is the same
};
std::unique_ptr<Solver> make_xpbd_solver(Model& model, XpbdTasks tasks = XpbdTasks::kWhole);

}  // namespace weft
