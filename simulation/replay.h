#pragma once

#include <cstdint>
#include <map>

#include "runtime/trace/records.h"
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
    const Step& step_for(const FrameRecord& recorded);
    void check(const Step& step, const std::vector<PlanRecord>& tasks, std::uint32_t frame) const;

    Simulation simulation_;
    const RunDescription& recorded_;
    std::map<std::uint32_t, Step> steps_;  ///< by number of the recorded graph
};

}  // namespace weft
