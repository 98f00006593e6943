#pragma once

#include <memory>
#include <vector>

#include "simulation/state/simulation_state.h"

namespace weft {

/// Copies of a simulation's state, which others may read while it goes on. Memory of copies that
/// nobody holds any more is used again: taking one is a plain copy then.
class Snapshots {
public:
    /// Of the host's copy of the state.
    std::shared_ptr<const SimulationState> take(const Model& model, Solver& solver);

private:
    std::vector<std::shared_ptr<SimulationState>> states_;
};

}  // namespace weft
