#pragma once

#include <span>
#include <vector>

#include "scheduler/plan.h"
#include "scheduler/task_graph.h"

namespace weft::scheduler {

/// A schedule under construction, shared by all list planners: tasks are placed one by one, each
/// after its predecessors, into the earliest gap of a processor that is long enough (insertion,
/// Topcuoglu et al. 2002, section 4.1). Working memory is kept from graph to graph.
class ScheduleBuilder {
public:
    /// A place that is free: its time, and its position in the processor's order.
    struct Gap {
        double start = 0.0;
        std::size_t position = 0;
    };

    /// Forgets everything; `graph` must outlive the construction.
    void begin(const TaskGraph& graph);

    /// When the data of the task's placed predecessors are at each processor. [processor]
    /// Predecessors that are not placed yet are passed over. Valid until the next call.
    std::span<const double> ready_times(TaskId task);

    /// The earliest gap of at least `cost` at or after `ready`. One in which the task would not end
    /// before `limit` is of no interest: then the answer is any gap that starts too late.
    Gap find_gap(ProcessorId p, double ready, double cost, double limit = kCannotRun) const;

    /// Puts the task into a gap that find_gap() gave.
    void place(TaskId task, ProcessorId p, Gap gap);
    /// Takes back the last of the tasks placed that has not been taken back.
    void remove_last();

    /// Places the task on this processor (which must be able to run it), as early as possible.
    void place_on(TaskId task, ProcessorId p);
    /// Places the task where it ends earliest; among equals on the lowest processor.
    void place_earliest(TaskId task);

    const Placement& placement(TaskId task) const { return placements_[task]; }

    /// A task of this processor that ends at or after `time` and is the first to do so.
    /// There must be one.
    TaskId task_ending_at(ProcessorId p, double time) const;

    /// Latest end of all tasks placed.
    double makespan() const;

    /// Writes the finished schedule; the bounds and flags of the plan are reset.
    void finish(Plan& plan, std::string_view algorithm) const;

private:
    struct Slot {
        double start, end;
        TaskId task;
    };
    /// The tasks of one processor by start, and for each block of kBlock slots the longest gap
    /// before one of them, rounded up: a search skips the blocks whose gaps are all too short.
    struct Lane {
        std::vector<Slot> slots;
        std::vector<double> longest_gap;

        void update_gaps(std::size_t from);
    };
    static constexpr std::size_t kBlock = 16;
    static constexpr ProcessorId kNotPlaced = ~ProcessorId{0};

    const TaskGraph* graph_ = nullptr;
    std::vector<Lane> lanes_;            // [processor]
    std::vector<Placement> placements_;  // [task]
    std::vector<double> ready_;          // [processor]
    std::vector<TaskId> history_;        // in order of placing
};

}  // namespace weft::scheduler
