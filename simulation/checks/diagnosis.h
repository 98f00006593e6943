#pragma once

#include "simulation/checks/watch.h"
#include "simulation/solver/solver.h"
#include "simulation/state/simulation_state.h"

namespace weft {

/// Runs a frame that went bad again from its start, on one core, by the tasks of the step that
/// failed, to name the substep, and the task and the vertex where these can be named: the bits are
/// the same on every device, so this finds what happened there. The host's state is that of the
/// frame's start again when it throws its RunError, which ends with the advice.
[[noreturn]] void diagnose_frame(int frame, const SimulationState& start, const Watch& watch,
                                 const Step& step, Model& model, Solver& solver,
                                 const std::string& advice);

}  // namespace weft
