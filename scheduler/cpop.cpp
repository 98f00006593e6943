#include "scheduler/cpop.h"

#include <algorithm>

#include "scheduler/ranks.h"

namespace weft::scheduler {

void Cpop::schedule(const TaskGraph& graph, Plan& plan) {
    upward_rank(graph, upward_);
    downward_rank(graph, priority_);
    for (TaskId t = 0; t < graph.task_count(); ++t) priority_[t] += upward_[t];
    mark_critical_path(graph);
    const ProcessorId fastest = fastest_on_path(graph);

    builder_.begin(graph);
    ready_.begin(graph, priority_);
    while (!ready_.empty()) {
        const TaskId task = ready_.take();
        if (critical_[task] && fastest < graph.processor_count()) {
            builder_.place_on(task, fastest);
        } else {
            builder_.place_earliest(task);
        }
    }
    builder_.finish(plan, name());
}

void Cpop::mark_critical_path(const TaskGraph& graph) {
    critical_.assign(graph.task_count(), false);
    path_.clear();
    TaskId task = graph.topological_order().front();
    for (const TaskId t : graph.topological_order()) {
        if (graph.predecessors(t).empty() && priority_[t] > priority_[task]) task = t;
    }
    while (true) {
        critical_[task] = true;
        path_.push_back(task);
        const std::span<const Arc> next = graph.successors(task);
        if (next.empty()) return;
        task = std::max_element(next.begin(), next.end(), [this](const Arc& a, const Arc& b) {
                   return a.mean_time + upward_[a.task] < b.mean_time + upward_[b.task];
               })->task;
    }
}

// The number of processors if none can run the whole path.
ProcessorId Cpop::fastest_on_path(const TaskGraph& graph) const {
    ProcessorId fastest = graph.processor_count();
    double least = kCannotRun;
    for (ProcessorId p = 0; p < graph.processor_count(); ++p) {
        double sum = 0.0;
        for (const TaskId t : path_) sum += graph.cost(t, p);
        if (sum < least) {
            least = sum;
            fastest = p;
        }
    }
    return fastest;
}

}  // namespace weft::scheduler
