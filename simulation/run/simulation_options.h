#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "runtime/device_list.h"
#include "runtime/planning/partition.h"
#include "runtime/planning/plan_kind.h"
#include "simulation/checks/start_contacts.h"
#include "simulation/run/troubles.h"
#include "simulation/solver/async_settings.h"
#include "simulation/solver/solver.h"

namespace weft {

/// How a scene is simulated.
struct SimulationOptions {
    std::string devices = "hybrid";
    PlanKind plan = PlanKind::kAuto;
    DeviceOptions device_options;
    std::optional<Division> division;  ///< fixed instead of planned
    std::filesystem::path cost_file;   ///< where costs are kept between runs; empty: nowhere
    bool calibrate = true;             ///< measure the devices at the start; needed to plan
    int iterates = 1;                  ///< that devices may have of their own (Partition::spread)
    AsyncSettings async;               ///< for PlanKind::kAsync
    /// Whether PlanKind::kAuto may take an asynchronous plan if that is predicted to be faster: the
    /// results are then others, and which, depends on measured times.
    bool may_be_async = false;
    /// Instead of the solver that the scene names, for tests and studies.
    std::function<std::unique_ptr<Solver>(Model&)> make_solver = weft::make_solver;
    OnTrouble on_trouble = OnTrouble::kStop;
    OnCrossing on_crossing = OnCrossing::kStop;
};

}  // namespace weft
