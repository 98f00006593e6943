#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "scheduler/plan.h"
#include "scheduler/schedule_builder.h"
#include "scheduler/task_graph.h"

namespace weft::scheduler {

/// Shortens a plan by trying small changes: a task goes to another processor, or earlier or later
/// in the order in which tasks are placed; mostly tasks of the chain that determines the makespan.
/// Slightly worse plans are accepted at first (threshold accepting), none in the end. The same
/// graph, plan and budget give the same result.
class LocalSearch {
public:
    /// Spends at most `evaluations` schedules. Stops early once the makespan is not above `bound`
    /// or `out_of_time`, which is asked now and then and may be empty, says so. Changes the plan's
    /// placements, order and makespan only if that makes it shorter; true if it did.
    bool improve(const TaskGraph& graph, Plan& plan, std::uint32_t evaluations, double bound,
                 const std::function<bool()>& out_of_time = {});

private:
    void start_from(const TaskGraph& graph, const Plan& plan);
    void find_tails(const TaskGraph& graph);
    void find_critical_chain(const TaskGraph& graph);
    bool change(const TaskGraph& graph);
    bool change_processor(const TaskGraph& graph, TaskId task, ProcessorId p);
    bool change_group(const TaskGraph& graph, TaskId task);
    bool change_position(const TaskGraph& graph, TaskId task);
    void move_task(std::uint32_t from, std::uint32_t to);
    void undo();
    double evaluate(const TaskGraph& graph, double limit);
    std::uint32_t random_below(std::uint32_t limit);

    struct Move {
        TaskId task;
        ProcessorId from;
    };

    std::vector<TaskId> order_;            // tasks are placed in this order
    std::vector<std::uint32_t> position_;  // [task] in order_
    std::vector<ProcessorId> processor_;   // [task]
    std::vector<double> tail_;             // [task] least time from its end to the end of all
    std::vector<TaskId> chain_;            // tasks that determine the makespan
    // The last change, for undo().
    std::vector<Move> moved_;
    std::uint32_t from_ = 0, to_ = 0;  // positions in order_
    std::uint64_t random_ = 0;
    ScheduleBuilder builder_;
};

}  // namespace weft::scheduler
