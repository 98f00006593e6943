#pragma once

#include "scheduler/planner.h"
#include "scheduler/ranks.h"
#include "scheduler/schedule_builder.h"

namespace weft::scheduler {

/// Heterogeneous earliest finish time with insertion (Topcuoglu, Hariri, Wu 2002): tasks by
/// descending upward rank, each where it ends earliest.
class Heft : public Planner {
public:
    enum class Rank {
        kUpward,       ///< as published
        kGaussSeidel,  ///< iterations in sequence, section 4.1.2 of the paper
    };

    explicit Heft(Rank rank = Rank::kUpward) : rule_(rank) {}

    std::string_view name() const override { return rule_ == Rank::kUpward ? "heft" : "heft-gs"; }
    void schedule(const TaskGraph& graph, Plan& plan) override;

private:
    Rank rule_;
    GaussSeidelRank gauss_seidel_rank_;
    std::vector<double> rank_;
    std::vector<TaskId> order_;
    ScheduleBuilder builder_;
};

}  // namespace weft::scheduler
