#pragma once

#include "runtime/planning/recorded_plans.h"
#include "simulation/simulation.h"

namespace weft {

/// Does the frames of a trace again: every task on the recorded device, in the recorded order.
///
/// With other devices than the recorded ones, what was device i's goes to device i modulo their
/// number. In strict arithmetic the results are the same.
class Replay {
public:
    /// scene  as recorded. options.plan and options.division are not used.
    Replay(const Scene& scene, const SimulationOptions& options, const RunDescription& recorded,
           Warnings& warnings);

    /// Does the next frame. Throws UserError if the record does not fit the scene, as when another
    /// version of Weft cuts it into other tasks; RunError like Simulation::advance().
    void advance(const FrameRecord& recorded);

    const Simulation& simulation() const { return simulation_; }

private:
    Simulation simulation_;
    RecordedPlans plans_;
};

}  // namespace weft
