#pragma once

#include "scheduler/planner.h"
#include "scheduler/schedule_builder.h"

namespace weft::scheduler {

/// High performance task scheduling (Ilavarasan, Thambidurai, Mahilmannan 2005): level by level;
/// within one by descending link cost, each task where it ends earliest.
///
/// The level is the largest number of edges from an entry task. The link cost is the largest
/// communication from a predecessor, plus the largest to a successor, plus the largest link cost
/// among the predecessors.
class Hps : public Planner {
public:
    std::string_view name() const override { return "hps"; }
    void schedule(const TaskGraph& graph, Plan& plan) override;

private:
    void find_levels_and_links(const TaskGraph& graph);

    std::vector<std::uint32_t> level_;
    std::vector<double> link_cost_;
    std::vector<TaskId> order_;
    ScheduleBuilder builder_;
};

}  // namespace weft::scheduler
