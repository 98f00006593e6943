#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "scheduler/plan.h"
#include "scheduler/planner.h"
#include "scheduler/portfolio.h"

namespace weft::scheduler {

struct SearchLimit {
    std::uint64_t nodes = 50'000'000;
    double seconds = 30.0;  ///< 0: no limit
};

/// Exact branch and bound for small graphs (about 15 tasks; with more than 200 it does not even
/// try). It places tasks in order of their start, each as early as its processor and its data
/// allow: some optimal schedule can be built that way. Sets Plan::proven_optimal, or Plan::gave_up
/// when a limit ended the search; the plan is then the best one found, never worse than the
/// portfolio's.
class Optimal : public Planner {
public:
    explicit Optimal(const SearchLimit& limit = {}) : limit_(limit) {}

    std::string_view name() const override { return "optimal"; }
    void schedule(const TaskGraph& graph, Plan& plan) override;

    /// Nodes of the last search.
    std::uint64_t nodes() const { return nodes_; }

private:
    struct Branch {
        double bound, start;
        TaskId task;
        ProcessorId processor;
    };

    void prepare(const TaskGraph& graph);
    void find_twins();
    void search(std::uint32_t depth);
    bool limit_reached();
    double bound_below();
    double last_start() const;
    double earliest_arrival(TaskId task, ProcessorId p) const;
    void collect_branches(std::vector<Branch>& branches);
    bool repeats(TaskId task, ProcessorId p, double start) const;
    void place(const Branch& branch);
    void unplace(const Branch& branch, double available, double area);
    void keep_best();
    void write_best(Plan& plan) const;

    SearchLimit limit_;
    std::uint64_t nodes_ = 0;
    bool stopped_ = false;
    std::chrono::steady_clock::time_point deadline_;
    std::uint64_t time_check_ = 1;  // nodes between two looks at the clock
    Portfolio portfolio_;
    LowerBounds bounds_;

    const TaskGraph* graph_ = nullptr;
    double best_ = 0.0;
    std::vector<Placement> best_placements_;
    std::vector<TaskId> best_sequence_;

    std::span<const double> tail_;    // [task][processor] least time from its start to the end
    std::vector<double> weight_;      // [processor] of the area bound
    std::vector<double> least_area_;  // [task] least weighted cost
    std::vector<ProcessorId> twin_;   // [processor] the one before it that is just alike
    // The partial schedule.
    std::vector<Placement> placements_;    // [task]
    std::vector<TaskId> sequence_;         // by start
    std::vector<std::uint32_t> missing_;   // [task] predecessors not placed
    std::vector<double> available_;        // [processor]
    std::vector<std::uint32_t> tasks_on_;  // [processor]
    std::vector<bool> placed_;             // [task]
    double area_left_ = 0.0;
    std::vector<double> earliest_end_;           // [task][processor] of bound_below()
    std::vector<std::vector<Branch>> branches_;  // [depth]
};

}  // namespace weft::scheduler
