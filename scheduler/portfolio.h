#pragma once

#include <chrono>
#include <cstdint>

#include "scheduler/cpop.h"
#include "scheduler/heft.h"
#include "scheduler/hps.h"
#include "scheduler/local_search.h"
#include "scheduler/lookahead.h"
#include "scheduler/peft.h"
#include "scheduler/planner.h"
#include "scheduler/single.h"

namespace weft::scheduler {

struct PortfolioBudget {
    /// Schedules that may be built. One takes about 25 ns per task and processor. With this limit
    /// alone the result is deterministic.
    std::uint32_t evaluations = 4000;
    /// Time that may be spent, looked at between the parts and in the search; 0: no limit.
    double seconds = 0.0;
};

/// The best of all the heuristics, then shortened by local search while the budget lasts. HEFT
/// always runs, then the single processors, then PEFT, CPOP, HPS, lookahead; so the plan is never
/// predicted to be worse than HEFT's. It stops as soon as a plan meets the lower bound.
class Portfolio : public Planner {
public:
    explicit Portfolio(const PortfolioBudget& budget = {}) : budget_(budget) {}

    std::string_view name() const override { return "portfolio"; }
    void schedule(const TaskGraph& graph, Plan& plan) override;

    void set_budget(const PortfolioBudget& budget) { budget_ = budget; }

private:
    void try_planner(Planner& planner, std::uint32_t evaluations, const TaskGraph& graph,
                     Plan& plan);
    bool out_of_time() const;

    PortfolioBudget budget_;
    std::chrono::steady_clock::time_point deadline_;
    std::uint32_t left_ = 0;  // evaluations
    double bound_ = 0.0;

    Heft heft_;
    Single single_;
    Peft peft_;
    Cpop cpop_;
    Hps hps_;
    Lookahead lookahead_;
    LocalSearch search_;
    LowerBounds bounds_;
    Plan candidate_;
};

}  // namespace weft::scheduler
