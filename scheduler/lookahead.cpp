#include "scheduler/lookahead.h"

#include <algorithm>
#include <utility>

#include "scheduler/ranks.h"

namespace weft::scheduler {

void Lookahead::schedule(const TaskGraph& graph, Plan& plan) {
    upward_rank(graph, rank_);
    order_by_rank(graph, rank_, order_);
    builder_.begin(graph);
    for (const TaskId task : order_) place_looking_ahead(graph, task);
    builder_.finish(plan, name());
}

void Lookahead::place_looking_ahead(const TaskGraph& graph, TaskId task) {
    next_.clear();
    for (const Arc& arc : graph.successors(task)) next_.push_back(arc.task);
    std::sort(next_.begin(), next_.end(), [&](TaskId a, TaskId b) {
        if (rank_[a] != rank_[b]) return rank_[a] > rank_[b];
        return graph.topological_index(a) < graph.topological_index(b);
    });
    next_.erase(std::unique(next_.begin(), next_.end()), next_.end());
    if (next_.empty()) {
        builder_.place_earliest(task);
        return;
    }
    std::pair best_end{kCannotRun, kCannotRun};  // of the successors, of the task itself
    ProcessorId best = 0;
    for (ProcessorId p = 0; p < graph.processor_count(); ++p) {
        if (!graph.can_run(task, p)) continue;
        builder_.place_on(task, p);
        const std::pair end{latest_successor_end(), builder_.placement(task).end};
        builder_.remove_last();
        if (end >= best_end) continue;
        best_end = end;
        best = p;
    }
    builder_.place_on(task, best);
}

// Predecessors of the successors that are not placed yet are ignored.
double Lookahead::latest_successor_end() {
    double latest = 0.0;
    for (const TaskId t : next_) {
        builder_.place_earliest(t);
        latest = std::max(latest, builder_.placement(t).end);
    }
    for (std::size_t i = 0; i < next_.size(); ++i) builder_.remove_last();
    return latest;
}

}  // namespace weft::scheduler
