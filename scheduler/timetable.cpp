#include "scheduler/timetable.h"

#include <algorithm>

#include "scheduler/assert.h"

namespace weft::scheduler {

void Timetable::begin(const TaskGraph& graph) {
    last_end_.clear();
    free_.assign(graph.processor_count(), 0.0);
}

/// Negative if something that it needs has not been taken.
double Timetable::earliest_start(const TaskGraph& graph, const Plan& plan, TaskId task,
                                 ProcessorId p) const {
    double start = free_[p];
    for (const Arc& arc : graph.predecessors(task)) {
        if (end_[arc.task] < 0.0) return -1.0;
        const ProcessorId from = plan.placements[arc.task].processor;
        start = std::max(start, end_[arc.task] + graph.transfer_time(arc, from, p));
    }
    if (last_end_.empty()) return start;
    for (std::uint32_t i = carried_begin_[task]; i < carried_begin_[task + 1]; ++i) {
        const CarriedEdge& edge = carried_[i];
        const ProcessorId from = plan.placements[edge.from].processor;
        start = std::max(start, last_end_[edge.from] + graph.transfer_time(edge.data, from, p));
    }
    return start;
}

/// The next task of the processor, if it can follow.
bool Timetable::take(const TaskGraph& graph, const Plan& plan, ProcessorId p,
                     std::span<const double> cost) {
    const auto row = plan.tasks_on(p);
    if (next_[p] == row.size()) return false;
    const TaskId task = row[next_[p]];
    const double start = earliest_start(graph, plan, task, p);
    if (start < 0.0) return false;
    end_[task] = free_[p] = start + cost[task];
    ++next_[p];
    return true;
}

/// One instance, behind what has run so far.
void Timetable::run(const TaskGraph& graph, const Plan& plan, std::span<const double> cost) {
    const ProcessorId processors = graph.processor_count();
    end_.assign(graph.task_count(), -1.0);
    next_.assign(processors, 0);
    std::size_t left = graph.task_count();
    while (left > 0) {
        const std::size_t before = left;
        for (ProcessorId p = 0; p < processors; ++p) {
            while (take(graph, plan, p, cost)) --left;
        }
        WEFT_ASSERT(left < before);
        if (left == before) break;
    }
}

double Timetable::makespan(const TaskGraph& graph, const Plan& plan, std::span<const double> cost) {
    begin(graph);
    run(graph, plan, cost);
    return std::ranges::max(free_);
}

void Timetable::set_times(const TaskGraph& graph, std::span<const double> cost, Plan& plan) {
    plan.makespan = makespan(graph, plan, cost);
    for (TaskId t = 0; t < graph.task_count(); ++t) {
        plan.placements[t].start = end_[t] - cost[t];
        plan.placements[t].end = end_[t];
    }
}

double Timetable::period(const TaskGraph& graph, const Plan& plan, std::span<const double> cost,
                         std::span<const CarriedEdge> carried) {
    carried_ = carried;
    carried_begin_.assign(std::size_t{graph.task_count()} + 1, 0);
    for (const CarriedEdge& edge : carried) ++carried_begin_[edge.to + 1];
    for (TaskId t = 0; t < graph.task_count(); ++t) carried_begin_[t + 1] += carried_begin_[t];
    begin(graph);
    run(graph, plan, cost);
    const double first = std::ranges::max(free_);
    constexpr int kFurther = 2;
    for (int i = 0; i < kFurther; ++i) {
        std::swap(last_end_, end_);
        run(graph, plan, cost);
    }
    return (std::ranges::max(free_) - first) / kFurther;
}

}  // namespace weft::scheduler
