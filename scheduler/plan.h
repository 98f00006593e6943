#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "scheduler/task_graph.h"

namespace weft::scheduler {

/// Where and when one task runs. Times are in the unit of the graph's costs; the graph starts at 0.
struct Placement {
    double start = 0.0;
    double end = 0.0;
    ProcessorId processor = 0;
};

/// Which processor runs each task, in which order, and when; and how far that may be from the best.
/// A plan is reused: planning into it again allocates nothing once it has grown.
struct Plan {
    std::vector<Placement> placements;  ///< [task]
    /// All tasks, by processor, then in order of execution: what executors go by. The times of the
    /// placements are a forecast.
    std::vector<TaskId> order;
    std::vector<std::uint32_t> order_begin;  ///< [processor + 1] rows of `order`
    double makespan = 0.0;                   ///< latest end

    /// Lower bounds of every schedule's makespan (bounds.h); 0 where they were not asked for.
    double path_bound = 0.0;
    double area_bound = 0.0;

    std::string_view algorithm;   ///< name of the planner
    std::string_view found_by;    ///< the same, or which of its parts found the plan
    bool proven_optimal = false;  ///< no schedule is shorter
    bool gave_up = false;         ///< an exact search stopped at its limit

    /// The best bound known of all schedules of the graph at hand: another division of the same
    /// work is another graph. The makespan itself once it is proven.
    double lower_bound() const {
        return proven_optimal ? makespan : std::min(makespan, std::max(path_bound, area_bound));
    }
    /// Whether the makespan equals its bound, but for rounding.
    bool meets_bound() const {
        return makespan <= std::max(path_bound, area_bound) * (1.0 + 1e-12);
    }
    /// At most this part of the makespan could be saved by a better plan: 1 - bound / makespan.
    double gap() const { return makespan > 0.0 ? 1.0 - lower_bound() / makespan : 0.0; }

    /// Fills the order from the placements of a plan that was made by hand; of tasks that start
    /// together the one with the lower number comes first.
    void order_by_start(ProcessorId processors);

    /// The tasks of one processor in order of execution.
    std::span<const TaskId> tasks_on(ProcessorId p) const {
        if (std::size_t{p} + 1 >= order_begin.size()) return {};
        return {order.data() + order_begin[p], order_begin[p + 1] - order_begin[p]};
    }
};

}  // namespace weft::scheduler
