#include "simulation/state/snapshots.h"

#include <algorithm>
#include <atomic>

namespace weft {

std::shared_ptr<const SimulationState> Snapshots::take(const Model& model, Solver& solver) {
    auto free = std::ranges::find_if(states_, [](const auto& s) { return s.use_count() == 1; });
    if (free == states_.end()) {
        free = states_.insert(states_.end(), std::make_shared<SimulationState>());
    }
    // Whoever held it last has read it before giving it up; from here on it is written.
    std::atomic_thread_fence(std::memory_order_acquire);
    (*free)->take(model, solver);
    return *free;
}

}  // namespace weft
