#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "scheduler/bounds.h"
#include "scheduler/plan.h"
#include "scheduler/task_graph.h"

namespace weft::scheduler {

/// Places the tasks of a graph onto its processors. A planner keeps its working memory from call to
/// call (no allocation in the steady state), so each thread uses its own.
///
/// Every planner is deterministic, with these rules where values tie: of two tasks with the same
/// priority the one that comes first in TaskGraph::topological_order() goes first; of two
/// processors on which a task ends equally early, the one with the lower number takes it.
class Planner {
public:
    virtual ~Planner() = default;

    /// Short lower-case name, as `make_planner` knows it.
    virtual std::string_view name() const = 0;

    /// Fills the plan, without its lower bounds unless they are needed for it. The graph must be
    /// sealed.
    virtual void schedule(const TaskGraph& graph, Plan& plan) = 0;

    /// Fills the plan, lower bounds included. Throws GraphError for a graph that is not sealed.
    void plan(const TaskGraph& graph, Plan& plan) {
        static_cast<void>(graph.topological_order());  // there is none before it is sealed
        schedule(graph, plan);
        if (plan.path_bound == 0.0) bounds_.apply(graph, plan);
    }

private:
    LowerBounds bounds_;
};

/// heft, peft, cpop, lookahead, hps, single, heft-gs (HEFT with the paper's Gauss-Seidel rank),
/// in-order, portfolio, optimal.
std::span<const std::string_view> planner_names();

/// A planner with its default settings. Throws std::invalid_argument for an unknown name.
std::unique_ptr<Planner> make_planner(std::string_view name);

}  // namespace weft::scheduler
