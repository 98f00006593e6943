#include "scheduler/grouping.h"

#include <algorithm>

namespace weft::scheduler {
namespace {

bool crosses(std::span<const Arc> arcs, const Plan& plan, ProcessorId own) {
    return std::ranges::any_of(
        arcs, [&](const Arc& arc) { return plan.placements[arc.task].processor != own; });
}

}  // namespace

void TaskGrouping::group(const TaskGraph& graph, const Plan& plan, std::span<const double> launch) {
    cut(graph, plan);
    predict(graph, plan, launch);
}

void TaskGrouping::cut(const TaskGraph& graph, const Plan& plan) {
    groups_.clear();
    group_of_.resize(graph.task_count());
    for (ProcessorId p = 0; p < graph.processor_count(); ++p) {
        bool open = false;
        for (std::uint32_t i = plan.order_begin[p]; i < plan.order_begin[p + 1]; ++i) {
            const TaskId task = plan.order[i];
            if (!open || crosses(graph.predecessors(task), plan, p)) {
                groups_.push_back({p, i, i, 0.0, 0.0});
            }
            groups_.back().end = i + 1;
            group_of_[task] = static_cast<std::uint32_t>(groups_.size()) - 1;
            open = !crosses(graph.successors(task), plan, p);
        }
    }
}

// Runs the plan's orders as soon as data and processors allow.
void TaskGrouping::predict(const TaskGraph& graph, const Plan& plan,
                           std::span<const double> launch) {
    const ProcessorId processors = graph.processor_count();
    missing_.resize(graph.task_count());
    for (TaskId t = 0; t < graph.task_count(); ++t) {
        missing_[t] = static_cast<std::uint32_t>(graph.predecessors(t).size());
    }
    placements_.resize(graph.task_count());
    available_.assign(processors, 0.0);
    next_.assign(plan.order_begin.begin(), plan.order_begin.end() - 1);
    makespan_ = 0.0;
    for (bool progress = true; progress;) {
        progress = false;
        for (ProcessorId p = 0; p < processors; ++p) {
            while (next_[p] < plan.order_begin[p + 1] && missing_[plan.order[next_[p]]] == 0) {
                run(graph, plan.order[next_[p]], p, next_[p], launch);
                ++next_[p];
                progress = true;
            }
        }
    }
}

void TaskGrouping::run(const TaskGraph& graph, TaskId task, ProcessorId p, std::uint32_t position,
                       std::span<const double> launch) {
    TaskGroup& group = groups_[group_of_[task]];
    double start = available_[p];
    for (const Arc& arc : graph.predecessors(task)) {
        const Placement& from = placements_[arc.task];
        start = std::max(start, from.end + graph.transfer_time(arc, from.processor, p));
    }
    if (position == group.begin) {
        group.start = start;
        if (!launch.empty()) start += launch[p];
    }
    const double end = start + graph.cost(task, p);
    placements_[task] = {start, end, p};
    available_[p] = group.finish = end;
    makespan_ = std::max(makespan_, end);
    for (const Arc& arc : graph.successors(task)) --missing_[arc.task];
}

}  // namespace weft::scheduler
