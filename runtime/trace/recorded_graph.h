#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/trace/records.h"
#include "scheduler/cost_model.h"
#include "scheduler/task_graph.h"

namespace weft {

/// What a machine's devices need for each kind of task, and for handing data to each other: of the
/// machine that recorded a trace, or of another one.
struct MachineCosts {
    std::vector<std::string> devices;    ///< names
    std::vector<std::uint32_t> numbers;  ///< of the devices, as tasks' homes name them
    std::vector<std::vector<std::optional<scheduler::LinearCost>>>
        kinds;                                   ///< [kind][device]; empty: it cannot run that kind
    std::vector<std::vector<double>> latency;    ///< [from][to] [s]; the diagonal does not count
    std::vector<std::vector<double>> bandwidth;  ///< [from][to] [bytes/s]; may be infinite

    /// Devices 0, 1, ... without a link's cost, for so many kinds.
    MachineCosts(std::vector<std::string> names, std::size_t kind_count);
};

/// The costs that a recorded frame was planned with, on the devices that it had: a run may have
/// lost some. Throws UserError for a damaged trace.
MachineCosts recorded_costs(const RunDescription& run, const FrameRecord& frame);

/// "0 tbb/1": a device of a run, short enough for tables and pictures.
std::string short_device_name(const RunDescription& run, std::size_t device);

/// "12 strips.3 4-7": number, kind, iteration and strips of a task.
std::string task_name(const RunDescription& run, const PlanRecord& task);

/// The plan's rows by task number. Throws UserError if they are not tasks 0, 1, ... of known kinds
/// on known devices, as in a damaged trace.
std::vector<PlanRecord> tasks_in_order(const RunDescription& run, const FrameRecord& frame);

/// The task graph of one substep of a recorded frame: planning it pinned, with the
/// recorded costs and planner, gives the recorded plan.
///
/// pinned  every task may run on its home device only. Tasks stay as large as the recorded division
///         of the strips made them, whatever the costs are.
/// Throws UserError for a trace without dependencies, and where no device can run a task.
scheduler::TaskGraph rebuild_graph(const RunDescription& run, const FrameRecord& frame,
                                   const MachineCosts& costs, bool pinned);

}  // namespace weft
