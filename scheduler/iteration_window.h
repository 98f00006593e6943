#pragma once

#include <cstdint>
#include <vector>

#include "scheduler/task_graph.h"

namespace weft::scheduler {

/// n-iteration concurrency (section 4.2.1 of the paper): how many iterations of a solver may be
/// worked on at a time. 1 is a barrier after every iteration; the paper takes 2; without a limit
/// only the tasks' own dependencies hold iterations back.
class IterationWindow {
public:
    /// Builds `limited`, sealed: `graph`, and a task of iteration i starts only after all tasks of
    /// the iterations up to i - open have ended, which it learns by a message without data. Tasks
    /// without an iteration are not concerned. `open` is at least 1; the graphs must be different
    /// objects. Throws GraphError if a task depends on one of a later iteration that would have to
    /// wait for it.
    void limit(const TaskGraph& graph, std::int32_t open, TaskGraph& limited);

private:
    void find_ends(const TaskGraph& graph);
    void add_waits(std::int32_t open, TaskGraph& limited) const;

    /// One iteration's tasks that no other task of it comes before, or after.
    struct Ends {
        std::int32_t iteration = 0;
        std::vector<TaskId> first, last;
    };
    std::vector<Ends> ends_;  // by iteration
};

}  // namespace weft::scheduler
