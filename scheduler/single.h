#pragma once

#include "scheduler/planner.h"
#include "scheduler/schedule_builder.h"

namespace weft::scheduler {

/// Everything on one processor: the one with the shortest makespan. Tasks that it cannot run go
/// where they end earliest, and those come in topological order like all others.
class Single : public Planner {
public:
    std::string_view name() const override { return "single"; }
    void schedule(const TaskGraph& graph, Plan& plan) override;

    /// The same on a processor of the caller's choice.
    void schedule_on(const TaskGraph& graph, ProcessorId processor, Plan& plan);

private:
    double build_on(const TaskGraph& graph, ProcessorId processor);

    ScheduleBuilder builder_;
};

}  // namespace weft::scheduler
