#include "scheduler/ready_queue.h"

#include <algorithm>

namespace weft::scheduler {

void ReadyQueue::begin(const TaskGraph& graph, std::span<const double> priority) {
    graph_ = &graph;
    priority_ = priority;
    missing_.resize(graph.task_count());
    heap_.clear();
    for (TaskId t = 0; t < graph.task_count(); ++t) {
        missing_[t] = static_cast<std::uint32_t>(graph.predecessors(t).size());
        if (missing_[t] == 0) push(t);
    }
}

bool ReadyQueue::later(TaskId a, TaskId b) const {
    if (priority_[a] != priority_[b]) return priority_[a] < priority_[b];
    return graph_->topological_index(a) > graph_->topological_index(b);
}

void ReadyQueue::push(TaskId task) {
    heap_.push_back(task);
    std::push_heap(heap_.begin(), heap_.end(), [this](TaskId a, TaskId b) { return later(a, b); });
}

TaskId ReadyQueue::take() {
    std::pop_heap(heap_.begin(), heap_.end(), [this](TaskId a, TaskId b) { return later(a, b); });
    const TaskId task = heap_.back();
    heap_.pop_back();
    for (const Arc& arc : graph_->successors(task)) {
        if (--missing_[arc.task] == 0) push(arc.task);
    }
    return task;
}

}  // namespace weft::scheduler
