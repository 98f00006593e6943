#pragma once

#include "scheduler/planner.h"
#include "scheduler/ready_queue.h"
#include "scheduler/schedule_builder.h"

namespace weft::scheduler {

/// Predict earliest finish time (Arabnejad, Barbosa 2014): among the tasks whose predecessors are
/// placed the one with the highest rank of the optimistic cost table goes where its end plus the
/// table's entry is least.
class Peft : public Planner {
public:
    std::string_view name() const override { return "peft"; }
    void schedule(const TaskGraph& graph, Plan& plan) override;

private:
    void place_optimistically(const TaskGraph& graph, TaskId task);

    std::vector<double> table_, rank_;
    ScheduleBuilder builder_;
    ReadyQueue ready_;
};

}  // namespace weft::scheduler
