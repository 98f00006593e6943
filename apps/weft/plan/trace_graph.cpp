#include "apps/weft/plan/trace_graph.h"

#include <fmt/format.h>

#include <charconv>
#include <sstream>
#include <utility>

#include "apps/weft/plan/cost_file.h"
#include "apps/weft/plan/divide_anew.h"
#include "apps/weft/trace/recorded_frames.h"
#include "runtime/error.h"

namespace weft {

namespace {

constexpr double kMicrosecond = 1e-6;

/// What a trace lacks is said with the trace's name.
template <class Action>
auto naming(const std::string& trace, Action action) {
    try {
        return action();
    } catch (const UserError& error) {
        throw UserError(trace + ": " + error.what());
    }
}

MachineCosts costs_for(const TraceRequest& request, const RunDescription& run,
                       const FrameRecord& frame) {
    if (request.costs) return read_cost_file(*request.costs, run.kinds);
    return naming(request.trace, [&] { return recorded_costs(run, frame); });
}

/// Empty for "auto".
std::vector<int> strip_list(const std::string& text) {
    std::vector<int> list;
    std::istringstream numbers(text == "auto" ? "" : text);
    for (std::string part; std::getline(numbers, part, ',');) {
        const auto [end, error] =
            std::from_chars(part.data(), part.data() + part.size(), list.emplace_back());
        if (error == std::errc() && end == part.data() + part.size() && list.back() >= 0) continue;
        list.clear();
        break;
    }
    if (!list.empty() || text == "auto") return list;
    throw UserError(
        fmt::format("--strips {}: expected auto, or a number of strips for each "
                    "device, as in 12,20",
                    text));
}

FrameRecord divide(const TraceRequest& request, const RunDescription& run,
                   const FrameRecord& recorded, const MachineCosts& costs) {
    const std::vector<int> strips = strip_list(*request.strips);
    FrameRecord frame = naming(request.trace, [&] { return divide_anew(run, costs, strips); });
    frame.frame = recorded.frame;
    return frame;
}

}  // namespace

TraceGraph read_trace_graph(const TraceRequest& request) {
    const TraceReader trace(request.trace);
    const RunDescription& run = trace.run();
    const FrameRecord frame = trace.frame(find_frame(trace, request.trace, request.frame));
    MachineCosts costs = costs_for(request, run, frame);
    const FrameRecord planned = request.strips ? divide(request, run, frame, costs) : frame;
    GraphFile file;
    file.processors = costs.devices;
    file.graph =
        naming(request.trace, [&] { return rebuild_graph(run, planned, costs, request.pinned); });
    file.unit = {1.0 / kMicrosecond, "us"};
    const std::uint32_t substeps = substeps_of(frame);
    const double measured = substeps > 0 ? frame.measured_makespan / substeps : 0.0;
    return {std::move(file), std::move(costs),
            run.scene_name,  run.kinds,
            frame.frame,     substeps,
            frame.planner,   planned_substep(frame),
            measured,        planned.graph->strips};
}

}  // namespace weft
