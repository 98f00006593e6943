#pragma once

#include <span>
#include <vector>

#include "scheduler/task_graph.h"

namespace weft::scheduler {

/// The tasks whose predecessors have all been taken, highest priority first; equal ones in
/// topological order.
class ReadyQueue {
public:
    /// Both arguments must outlive the walk.
    /// priority  [task]
    void begin(const TaskGraph& graph, std::span<const double> priority);

    bool empty() const { return heap_.empty(); }
    /// Takes the first task; its successors may become ready by that.
    TaskId take();

private:
    bool later(TaskId a, TaskId b) const;
    void push(TaskId task);

    const TaskGraph* graph_ = nullptr;
    std::span<const double> priority_;
    std::vector<std::uint32_t> missing_;  // [task] predecessors not taken yet
    std::vector<TaskId> heap_;
};

}  // namespace weft::scheduler
