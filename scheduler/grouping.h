#pragma once

#include <span>
#include <vector>

#include "scheduler/plan.h"
#include "scheduler/task_graph.h"

namespace weft::scheduler {

/// Consecutive tasks of one processor that can be handed to it at once: only the first one waits
/// for data of another processor, only the last one is waited for by another.
struct TaskGroup {
    ProcessorId processor = 0;
    std::uint32_t begin = 0, end = 0;  ///< tasks Plan::order[begin, end)
    double start = 0.0, finish = 0.0;
};

/// Cuts each processor's tasks into groups (section 3.3.3 of the paper) and predicts the makespan
/// with what it costs to launch a group, which planners do not know.
class TaskGrouping {
public:
    /// launch  [processor] time that passes on the processor before the first task of a group; may
    /// be
    ///         empty: then the predicted times are the plan's, with all gaps closed that its order
    ///         allows.
    void group(const TaskGraph& graph, const Plan& plan, std::span<const double> launch = {});

    /// By processor, then in order of execution.
    std::span<const TaskGroup> groups() const { return groups_; }
    /// Which group a task is in. [task]
    std::span<const std::uint32_t> group_of() const { return group_of_; }
    /// Predicted makespan, launches included.
    double makespan() const { return makespan_; }
    /// Predicted start and end of each task, launches included. [task]
    std::span<const Placement> placements() const { return placements_; }

private:
    void cut(const TaskGraph& graph, const Plan& plan);
    void predict(const TaskGraph& graph, const Plan& plan, std::span<const double> launch);
    void run(const TaskGraph& graph, TaskId task, ProcessorId p, std::uint32_t position,
             std::span<const double> launch);

    std::vector<TaskGroup> groups_;
    std::vector<std::uint32_t> group_of_;
    std::vector<Placement> placements_;
    std::vector<std::uint32_t> missing_;  // [task] predecessors that have not run
    std::vector<double> available_;       // [processor]
    std::vector<std::uint32_t> next_;     // [processor] position in Plan::order
    double makespan_ = 0.0;
};

}  // namespace weft::scheduler
