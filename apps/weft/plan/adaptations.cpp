#include "apps/weft/plan/adaptations.h"

#include "scheduler/iteration_window.h"
#include "scheduler/merging.h"

namespace weft {

using scheduler::TaskGraph;

void adapt(TaskGraph& graph, const Adaptations& adaptations) {
    if (adaptations.merge) {
        TaskGraph merged;
        scheduler::TaskMerger().merge(graph, *adaptations.merge, merged);
        graph = std::move(merged);
    }
    if (adaptations.open_iterations) {
        TaskGraph limited;
        scheduler::IterationWindow().limit(graph, *adaptations.open_iterations, limited);
        graph = std::move(limited);
    }
}

}  // namespace weft
