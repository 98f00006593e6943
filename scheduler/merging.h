#pragma once

#include <vector>

#include "scheduler/task_graph.h"

namespace weft::scheduler {

/// Task merging (section 4.1.1 of the paper): where communication costs more than one small task
/// gains on the better device, a list planner never changes the device, though a row of such tasks
/// would be worth it. So consecutive tasks of one kind are merged until they are large enough.
///
/// A task may be merged with the one before it in topological order if both have the same kind >= 0
/// and iteration, the same processors can run them, and the sum of average costs so far is below
/// `enough`. Of the ready tasks one of the present kind comes first, so rows are as long as can be.
/// Merging rows of a topological order never makes a cycle.
class TaskMerger {
public:
    /// Builds `merged`, sealed, with the processors and links of `graph`. Costs add up; edges
    /// inside a merged task vanish; the others stay, so two merged tasks may have several edges. A
    /// merged task keeps the name of its first task. The graphs must be different objects.
    void merge(const TaskGraph& graph, double enough, TaskGraph& merged);

    /// The tasks of a merged task, in the order in which they are to run.
    std::span<const TaskId> tasks_of(TaskId merged) const {
        return {order_.data() + begin_[merged], begin_[merged + 1] - begin_[merged]};
    }

private:
    void order_by_kind(const TaskGraph& graph);
    void cut_rows(const TaskGraph& graph, double enough);
    void build(const TaskGraph& graph, TaskGraph& merged);

    std::vector<TaskId> order_;           // tasks of the original graph, row by row
    std::vector<std::uint32_t> begin_;    // [merged task + 1] rows of order_
    std::vector<TaskId> merged_of_;       // [task]
    std::vector<std::uint32_t> missing_;  // [task] predecessors not taken yet
    std::vector<TaskId> ready_;
    std::vector<double> cost_;  // [processor]
};

}  // namespace weft::scheduler
