#pragma once

#include <span>
#include <vector>

#include "scheduler/plan.h"
#include "scheduler/task_graph.h"

namespace weft::scheduler {

/// Bounds that no schedule of a graph can beat.
///
/// Path: with unlimited copies of every processor, a task on processor p cannot end before
///     head(t, p) = cost(t, p) + max over predecessors u of
///                               min over q of (head(u, q) + comm(u, t, q, p)),
/// and from its start to the end of all it takes at least tail(t, p), which is the same over its
/// successors. So no schedule is shorter than the largest over all tasks of
///     min over p of (head(t, p) + tail(t, p) - cost(t, p)).
///
/// Area: if all edges are dropped and tasks may be split at will, the best balance of the
/// processors' loads is a linear program; its dual is the largest, over all weights w >= 0 whose
/// sum is 1, of
///     sum over tasks of min over p of w_p cost(t, p).
/// Every w gives a valid bound. The best one is found by column generation: exactly (to
/// 1e-9), or to 1e-4 for more than 200 tasks.
class LowerBounds {
public:
    /// Sets the bounds of the plan; a plan that meets its bound is marked as proven optimal.
    void apply(const TaskGraph& graph, Plan& plan);

    double path(const TaskGraph& graph);
    /// tail(t, p) of the last path(): least time from the start of the task on the processor to the
    /// end of all. [task][processor]
    std::span<const double> tails() const { return tail_; }

    double area(const TaskGraph& graph);

    /// The processors' weights that belong to the last area(); they sum to 1. [processor]
    std::span<const double> area_weights() const { return best_weights_; }

private:
    void find_heads(const TaskGraph& graph);
    double cheapest_load(const TaskGraph& graph, std::span<const double> weights);
    double start_basis(const TaskGraph& graph);
    void read_duals(std::size_t processors);
    bool bring_in_column(std::size_t processors);

    std::vector<double> head_;                           // [task][processor]
    std::vector<double> tail_;                           // [task][processor]
    std::vector<double> load_, weights_, best_weights_;  // [processor]
    // The revised simplex method on processors + 1 rows, see bounds.cpp.
    std::vector<double> inverse_, value_, column_, direction_;
};

}  // namespace weft::scheduler
