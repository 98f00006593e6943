#pragma once

#include <optional>

#include "simulation/checks/outside_work.h"

namespace weft {

/// By pins that all move as one rigid body, at one velocity or about one axis, where nothing else
/// is held and nothing else pushes: what they do is their push and their torque times that motion,
/// and these are what everything else has gained of momentum and of angular momentum, and gravity
/// and damping do not account for. None: they move in other ways, or some stay. As outside_work()
/// has it
std::optional<OutsideWork> work_of_pins(const Model& model, const SimulationState& before,
                                        double start, double end);

}  // namespace weft
