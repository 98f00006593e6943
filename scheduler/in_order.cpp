#include "scheduler/in_order.h"

#include <algorithm>

namespace weft::scheduler {

double InOrder::start_on(const TaskGraph& graph, TaskId task, ProcessorId p) const {
    double start = free_[p];
    for (const Arc& arc : graph.predecessors(task)) {
        const Placement& from = placements_[arc.task];
        start = std::max(start, from.end + graph.transfer_time(arc, from.processor, p));
    }
    return start;
}

void InOrder::place_all(const TaskGraph& graph) {
    free_.assign(graph.processor_count(), 0.0);
    placements_.resize(graph.task_count());
    for (const TaskId task : graph.topological_order()) {
        Placement best{0.0, kCannotRun, 0};
        for (ProcessorId p = 0; p < graph.processor_count(); ++p) {
            if (!graph.can_run(task, p)) continue;
            const double start = start_on(graph, task, p);
            const double end = start + graph.cost(task, p);
            if (end < best.end) best = {start, end, p};
        }
        placements_[task] = best;
        free_[best.processor] = best.end;
    }
}

double InOrder::makespan(const TaskGraph& graph) {
    place_all(graph);
    return std::ranges::max(free_);
}

void InOrder::schedule(const TaskGraph& graph, Plan& plan) {
    plan.makespan = makespan(graph);
    plan.placements.assign(placements_.begin(), placements_.end());
    plan.order.clear();
    plan.order_begin.assign(1, 0);
    for (ProcessorId p = 0; p < graph.processor_count(); ++p) {
        for (const TaskId task : graph.topological_order()) {
            if (placements_[task].processor == p) plan.order.push_back(task);
        }
        plan.order_begin.push_back(static_cast<std::uint32_t>(plan.order.size()));
    }
    plan.path_bound = plan.area_bound = 0.0;
    plan.algorithm = plan.found_by = name();
    plan.proven_optimal = plan.gave_up = false;
}

}  // namespace weft::scheduler
