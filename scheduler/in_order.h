#pragma once

#include <vector>

#include "scheduler/planner.h"

namespace weft::scheduler {

/// The caller's own order: tasks in topological order, the lowest id first, each behind the last
/// task of the processor on which it then ends earliest. For graphs whose author knew a good order,
/// and a quarter of HEFT's time: no ranks, no insertion.
class InOrder : public Planner {
public:
    std::string_view name() const override { return "in-order"; }
    void schedule(const TaskGraph& graph, Plan& plan) override;

    /// Only how long the plan takes.
    double makespan(const TaskGraph& graph);

private:
    void place_all(const TaskGraph& graph);
    double start_on(const TaskGraph& graph, TaskId task, ProcessorId p) const;

    std::vector<Placement> placements_;  // [task]
    std::vector<double> free_;           // [processor]
};

}  // namespace weft::scheduler
