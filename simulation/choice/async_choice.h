#pragma once

#include <optional>
#include <string>

#include "simulation/run/live_model.h"
#include "simulation/run/simulation_options.h"

namespace weft {

/// Whether PlanKind::kAuto takes an asynchronous plan.
struct AsyncChoice {
    std::optional<AsyncSettings> settings;  ///< of the plan to be taken; none: one that waits
    std::string why;                        ///< one line; empty: nobody has asked
};

/// On devices that are calibrated.
AsyncChoice choose_async(const SimulationOptions& options, LiveModel& live);

}  // namespace weft
