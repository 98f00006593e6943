#pragma once

#include <cstddef>

#include "simulation/run/live_model.h"
#include "simulation/run/simulation_options.h"

namespace weft {

/// How the solvers of a run are made: with as many iterates as its options ask for, or asynchronous
/// devices need.
LiveModel::SolverMaker solver_maker(const SimulationOptions& options, std::size_t devices);

}  // namespace weft
