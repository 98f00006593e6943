#pragma once

#include <span>
#include <vector>

#include "scheduler/task_graph.h"

namespace weft::scheduler {

// Priorities of tasks, from average costs (over the processors that can run the task) and average
// communication times (over all ordered pairs of different processors). Larger means earlier.

/// rank_u(i) = w_i + max over successors j of (c_ij + rank_u(j)).  Topcuoglu et al. 2002, eq. 5.
void upward_rank(const TaskGraph& graph, std::vector<double>& rank);

/// rank_d(i) = max over predecessors j of (rank_d(j) + w_j + c_ji).  Topcuoglu et al. 2002, eq. 6.
void downward_rank(const TaskGraph& graph, std::vector<double>& rank);

/// rank_u of a graph in which the solver's iterations follow each other: all tasks with
/// TaskTraits::iteration >= 0, taken by iteration and within one by topological order, are linked
/// each to the next without communication. So tasks of later iterations have smaller ranks, and the
/// published Gauss-Seidel order is kept (section 4.1.2 of the paper), although the tasks may
/// overlap. Throws GraphError if a task depends on one of a later iteration.
class GaussSeidelRank {
public:
    void operator()(const TaskGraph& graph, std::vector<double>& rank);

private:
    void link_iterations(const TaskGraph& graph);

    std::vector<TaskId> sequence_;  // the tasks of the iterations
    std::vector<TaskId> next_;      // [task] its successor in the sequence
    std::vector<TaskId> previous_;  // [task]
    std::vector<std::uint32_t> open_;
    std::vector<TaskId> stack_;
};

/// Optimistic cost table of PEFT (Arabnejad, Barbosa 2014, eq. 4 and 5):
///     oct(i, p) = max over successors j of
///                 min over q of (oct(j, q) + w(j, q) + (q == p ? 0 : c_ij)),
/// and as rank its average over the processors that can run the task.
/// table  [task][processor]
void optimistic_cost_table(const TaskGraph& graph, std::vector<double>& table,
                           std::vector<double>& rank);

/// Sorts all tasks by descending rank; equal ones in topological order.
void order_by_rank(const TaskGraph& graph, std::span<const double> rank,
                   std::vector<TaskId>& order);

}  // namespace weft::scheduler
