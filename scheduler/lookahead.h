#pragma once

#include "scheduler/planner.h"
#include "scheduler/schedule_builder.h"

namespace weft::scheduler {

/// Lookahead HEFT (Bittencourt, Sakellariou, Madeira 2010): HEFT, but a task goes where the latest
/// of its successors would end earliest, if they were placed next, one after the other by rank. Of
/// equal processors that on which the task itself ends earliest.
class Lookahead : public Planner {
public:
    std::string_view name() const override { return "lookahead"; }
    void schedule(const TaskGraph& graph, Plan& plan) override;

private:
    void place_looking_ahead(const TaskGraph& graph, TaskId task);
    double latest_successor_end();

    std::vector<double> rank_;
    std::vector<TaskId> order_;
    std::vector<TaskId> next_;  // successors of the present task, by rank
    ScheduleBuilder builder_;
};

}  // namespace weft::scheduler
