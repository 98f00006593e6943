#include "scheduler/merging.h"

#include <algorithm>

namespace weft::scheduler {
namespace {

bool same_processors(const TaskGraph& graph, TaskId a, TaskId b) {
    for (ProcessorId p = 0; p < graph.processor_count(); ++p) {
        if (graph.can_run(a, p) != graph.can_run(b, p)) return false;
    }
    return true;
}

bool may_share(const TaskGraph& graph, TaskId a, TaskId b) {
    return graph.kind(a) >= 0 && graph.kind(a) == graph.kind(b) &&
           graph.iteration(a) == graph.iteration(b) && same_processors(graph, a, b);
}

}  // namespace

void TaskMerger::merge(const TaskGraph& graph, double enough, TaskGraph& merged) {
    order_by_kind(graph);
    cut_rows(graph, enough);
    build(graph, merged);
}

void TaskMerger::order_by_kind(const TaskGraph& graph) {
    const TaskId n = graph.task_count();
    missing_.resize(n);
    ready_.clear();
    order_.clear();
    for (TaskId t = 0; t < n; ++t) {
        missing_[t] = static_cast<std::uint32_t>(graph.predecessors(t).size());
        if (missing_[t] == 0) ready_.push_back(t);
    }
    while (!ready_.empty()) {
        const auto before = [&](TaskId a, TaskId b) {
            if (!order_.empty()) {
                const bool row_a = may_share(graph, order_.back(), a);
                const bool row_b = may_share(graph, order_.back(), b);
                if (row_a != row_b) return row_a;
            }
            return graph.topological_index(a) < graph.topological_index(b);
        };
        const auto next = std::min_element(ready_.begin(), ready_.end(), before);
        const TaskId task = *next;
        ready_.erase(next);
        order_.push_back(task);
        for (const Arc& arc : graph.successors(task)) {
            if (--missing_[arc.task] == 0) ready_.push_back(arc.task);
        }
    }
}

void TaskMerger::cut_rows(const TaskGraph& graph, double enough) {
    merged_of_.resize(graph.task_count());
    begin_.clear();
    double sum = 0.0;
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
        const bool joins = i > 0 && sum < enough && may_share(graph, order_[i - 1], order_[i]);
        if (!joins) {
            begin_.push_back(i);
            sum = 0.0;
        }
        sum += graph.mean_cost(order_[i]);
        merged_of_[order_[i]] = static_cast<TaskId>(begin_.size()) - 1;
    }
    begin_.push_back(static_cast<std::uint32_t>(order_.size()));
}

void TaskMerger::build(const TaskGraph& graph, TaskGraph& merged) {
    const ProcessorId processors = graph.processor_count();
    merged.clear(processors);
    merged.copy_links(graph);
    cost_.resize(processors);
    for (TaskId m = 0; m + 1 < begin_.size(); ++m) {
        std::fill(cost_.begin(), cost_.end(), 0.0);
        for (const TaskId t : tasks_of(m)) {
            for (ProcessorId p = 0; p < processors; ++p) cost_[p] += graph.cost(t, p);
        }
        const TaskId first = order_[begin_[m]];
        merged.add_task(cost_, {.kind = graph.kind(first),
                                .iteration = graph.iteration(first),
                                .name = graph.name(first)});
    }
    for (const TaskId t : order_) {
        for (const Arc& arc : graph.successors(t)) {
            if (merged_of_[t] == merged_of_[arc.task]) continue;
            merged.add_edge(merged_of_[t], merged_of_[arc.task], arc.data);
        }
    }
    merged.seal();
}

}  // namespace weft::scheduler
