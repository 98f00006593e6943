#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/weft/plan/graph_file.h"
#include "runtime/trace/recorded_graph.h"

namespace weft {

/// Which frame of a trace is to be planned anew, and with which costs.
struct TraceRequest {
    std::string trace;
    std::optional<std::uint32_t> frame;  ///< none: the last one
    std::optional<std::string> costs;    ///< file; none: as recorded
    std::optional<std::string> strips;   ///< "auto" or "12,20" per device; none: as recorded
    bool pinned = false;
};

/// A recorded frame as a task graph in seconds, and what became of it in the run.
struct TraceGraph {
    GraphFile file;
    MachineCosts costs;
    std::string scene;
    std::vector<std::string> kinds;
    std::uint32_t frame = 0;
    std::uint32_t substeps = 0;
    std::string planner;                ///< that the run used
    double planned = 0.0;               ///< one substep, by the recorded plan
    double measured = 0.0;              ///< one substep, on average
    std::vector<std::uint32_t> strips;  ///< [device] that its tasks are cut for
};

/// Throws UserError.
TraceGraph read_trace_graph(const TraceRequest& request);

}  // namespace weft
