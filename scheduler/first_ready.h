#pragma once

#include <vector>

#include "scheduler/plan.h"
#include "scheduler/task_graph.h"

namespace weft::scheduler {

/// Orders the tasks of processors that are given theirs: each processor takes of those that it
/// could start earliest the one whose data were there first. So what comes last in one part of the
/// work, and what follows it in the next round, is done while other parts are still busy.
class FirstReady {
public:
    /// Fills order, times and makespan of a plan whose placements name the processors.
    void order(const TaskGraph& graph, Plan& plan);

private:
    struct Waiting {
        TaskId task;
        double ready;
    };
    void release(const TaskGraph& graph, const Plan& plan, TaskId task);
    Waiting take(ProcessorId p);
    ProcessorId earliest() const;

    std::vector<std::vector<Waiting>> waiting_;  // [processor]
    std::vector<double> free_;                   // [processor]
    std::vector<std::uint32_t> missing_;         // [task] predecessors not done yet
    std::vector<std::vector<TaskId>> rows_;      // [processor]
};

}  // namespace weft::scheduler
