#include "scheduler/hps.h"

#include <algorithm>

namespace weft::scheduler {

void Hps::schedule(const TaskGraph& graph, Plan& plan) {
    find_levels_and_links(graph);
    const std::span<const TaskId> topological = graph.topological_order();
    order_.assign(topological.begin(), topological.end());
    std::sort(order_.begin(), order_.end(), [&](TaskId a, TaskId b) {
        if (level_[a] != level_[b]) return level_[a] < level_[b];
        if (link_cost_[a] != link_cost_[b]) return link_cost_[a] > link_cost_[b];
        return graph.topological_index(a) < graph.topological_index(b);
    });
    builder_.begin(graph);
    for (const TaskId task : order_) builder_.place_earliest(task);
    builder_.finish(plan, name());
}

void Hps::find_levels_and_links(const TaskGraph& graph) {
    level_.assign(graph.task_count(), 0);
    link_cost_.resize(graph.task_count());
    for (const TaskId t : graph.topological_order()) {
        double from = 0.0, to = 0.0, before = 0.0;
        for (const Arc& arc : graph.predecessors(t)) {
            level_[t] = std::max(level_[t], level_[arc.task] + 1);
            from = std::max(from, arc.mean_time);
            before = std::max(before, link_cost_[arc.task]);
        }
        for (const Arc& arc : graph.successors(t)) to = std::max(to, arc.mean_time);
        link_cost_[t] = from + to + before;
    }
}

}  // namespace weft::scheduler
