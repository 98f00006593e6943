#include "scheduler/first_ready.h"

#include <algorithm>

namespace weft::scheduler {

/// All that comes before it has been done.
void FirstReady::release(const TaskGraph& graph, const Plan& plan, TaskId task) {
    const ProcessorId p = plan.placements[task].processor;
    double ready = 0.0;
    for (const Arc& arc : graph.predecessors(task)) {
        const Placement& from = plan.placements[arc.task];
        ready = std::max(ready, from.end + graph.transfer_time(arc, from.processor, p));
    }
    waiting_[p].push_back({task, ready});
}

/// The processor that could start a task first.
ProcessorId FirstReady::earliest() const {
    ProcessorId best = 0;
    double best_start = kCannotRun;
    for (ProcessorId p = 0; p < waiting_.size(); ++p) {
        for (const Waiting& w : waiting_[p]) {
            const double start = std::max(free_[p], w.ready);
            if (start >= best_start) continue;
            best_start = start;
            best = p;
        }
    }
    return best;
}

FirstReady::Waiting FirstReady::take(ProcessorId p) {
    const auto first = std::ranges::min_element(waiting_[p], [](const auto& a, const auto& b) {
        return a.ready != b.ready ? a.ready < b.ready : a.task < b.task;
    });
    const Waiting taken = *first;
    *first = waiting_[p].back();
    waiting_[p].pop_back();
    return taken;
}

void FirstReady::order(const TaskGraph& graph, Plan& plan) {
    const ProcessorId processors = graph.processor_count();
    waiting_.resize(processors);
    rows_.resize(processors);
    for (auto& row : rows_) row.clear();
    free_.assign(processors, 0.0);
    missing_.resize(graph.task_count());
    for (TaskId t = 0; t < graph.task_count(); ++t) {
        missing_[t] = static_cast<std::uint32_t>(graph.predecessors(t).size());
        if (missing_[t] == 0) release(graph, plan, t);
    }
    for (TaskId done = 0; done < graph.task_count(); ++done) {
        const ProcessorId p = earliest();
        const auto [task, ready] = take(p);
        Placement& own = plan.placements[task];
        own.start = std::max(free_[p], ready);
        own.end = free_[p] = own.start + graph.cost(task, p);
        rows_[p].push_back(task);
        for (const Arc& arc : graph.successors(task)) {
            if (--missing_[arc.task] == 0) release(graph, plan, arc.task);
        }
    }
    plan.makespan = std::ranges::max(free_);
    plan.order.clear();
    plan.order_begin.assign(1, 0);
    for (const auto& row : rows_) {
        plan.order.insert(plan.order.end(), row.begin(), row.end());
        plan.order_begin.push_back(static_cast<std::uint32_t>(plan.order.size()));
    }
}

}  // namespace weft::scheduler
