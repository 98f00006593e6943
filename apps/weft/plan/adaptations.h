#pragma once

#include <optional>

#include "scheduler/task_graph.h"

namespace weft {

/// What the paper does to a graph before it is planned; by default nothing.
struct Adaptations {
    std::optional<double> merge;         ///< average cost from which a merged task is large enough
    std::optional<int> open_iterations;  ///< at most so many at a time
};

/// Changes the graph, which stays sealed. Throws scheduler::GraphError where a limit cannot be
/// kept.
void adapt(scheduler::TaskGraph& graph, const Adaptations& adaptations);

}  // namespace weft
