#pragma once

#include <span>
#include <vector>

#include "scheduler/plan.h"
#include "scheduler/task_graph.h"

namespace weft::scheduler {

/// An edge from a task of one instance of a graph to a task of the next one.
struct CarriedEdge {
    TaskId from = 0;
    TaskId to = 0;
    double data = 0.0;
};

/// When the tasks of a plan run if they take other times than it was made with: each processor its
/// tasks in the plan's order, each as soon as its data are there. What a plan took and what it
/// would take now, without touching the graph that it was made from. The plan's order must respect
/// the dependencies.
class Timetable {
public:
    /// Latest end.
    /// cost  [task] on the processor that the plan gives it to
    double makespan(const TaskGraph& graph, const Plan& plan, std::span<const double> cost);

    /// Sets the plan's times and makespan to these.
    void set_times(const TaskGraph& graph, std::span<const double> cost, Plan& plan);

    /// What each further instance of the graph takes if many run one after the other by the same
    /// plan: the ends of one overlap with the beginnings of the next.
    /// carried  by ascending `to`
    double period(const TaskGraph& graph, const Plan& plan, std::span<const double> cost,
                  std::span<const CarriedEdge> carried);

private:
    void begin(const TaskGraph& graph);
    void run(const TaskGraph& graph, const Plan& plan, std::span<const double> cost);
    bool take(const TaskGraph& graph, const Plan& plan, ProcessorId p,
              std::span<const double> cost);
    double earliest_start(const TaskGraph& graph, const Plan& plan, TaskId task,
                          ProcessorId p) const;

    std::vector<double> end_;          // [task]; negative: not taken yet
    std::vector<double> last_end_;     // [task] of the instance before; empty: there is none
    std::vector<double> free_;         // [processor]
    std::vector<std::uint32_t> next_;  // [processor] in its row of the order
    std::span<const CarriedEdge> carried_;
    std::vector<std::uint32_t> carried_begin_;  // [task + 1] rows of carried_
};

}  // namespace weft::scheduler
