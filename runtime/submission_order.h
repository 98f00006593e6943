#pragma once

#include <vector>

#include "runtime/step.h"
#include "scheduler/plan.h"

namespace weft {

/// All tasks of a step in the order in which they are submitted: each device's as the plan orders
/// them, none before what it waits for, and of those that could come next the one that is planned
/// to start first. The plan's order must be one that can be followed.
std::vector<int> submission_order(const Step& step, const scheduler::Plan& plan);

}  // namespace weft
