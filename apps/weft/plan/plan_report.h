#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/weft/plan/timed_plan.h"
#include "apps/weft/plan/trace_graph.h"

/// What `weft plan` says, as text and as JSON; times of JSON are those of the graph.
///
/// trace: that the graph is a frame of; null where it is none's.
namespace weft {

/// What is planned, and what became of it in the run.
std::string frame_text(const TraceGraph& trace);

/// Tasks, a chart, and how good the plan is.
std::string plan_report(const GraphFile& file, const TimedPlan& result);
nlohmann::ordered_json plan_json(const GraphFile& file, const TimedPlan& result,
                                 const TraceGraph* trace);

/// A row for each of the plans, of which there is at least one.
std::string comparison_text(const GraphFile& file, const std::vector<TimedPlan>& rows);
nlohmann::ordered_json comparison_json(const GraphFile& file, const std::vector<TimedPlan>& rows,
                                       const TraceGraph* trace);

}  // namespace weft
