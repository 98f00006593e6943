#include "apps/weft/plan/plan_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/weft/plan/plan_text.h"

namespace weft {
namespace {

using nlohmann::ordered_json;
using scheduler::Plan;
using scheduler::TaskId;

std::string verdict(const Plan& plan) {
    if (plan.proven_optimal) return "optimal";
    return plan.gave_up ? "gave up at its limit" : "";
}

ordered_json summary_json(const TimedPlan& result) {
    const Plan& plan = result.plan;
    return {{"algorithm", plan.algorithm},
            {"found_by", plan.found_by},
            {"makespan", plan.makespan},
            {"lower_bound", plan.lower_bound()},
            {"path_bound", plan.path_bound},
            {"area_bound", plan.area_bound},
            {"gap", plan.gap()},
            {"proven_optimal", plan.proven_optimal},
            {"gave_up", plan.gave_up},
            {"plan_us", 1e6 * result.seconds}};
}

/// What JSON says of a recorded frame, in seconds.
ordered_json frame_json(const TraceGraph& trace) {
    return {
        {"scene", trace.scene},
        {"frame", trace.frame},
        {"substeps", trace.substeps},
        {"strips", trace.strips},
        {"recorded",
         {{"planner", trace.planner}, {"makespan", trace.planned}, {"measured", trace.measured}}}};
}

std::string time_text(const GraphFile& file, double time) {
    return fmt::format("{:.8g}{}{}", file.unit.factor * time, file.unit.name.empty() ? "" : " ",
                       file.unit.name);
}

/// Of all: one row may prove more than the others.
double lower_bound(const std::vector<TimedPlan>& rows) {
    double bound = 0.0;
    for (const TimedPlan& row : rows) bound = std::max(bound, row.plan.lower_bound());
    return bound;
}

std::string comparison_row(const GraphFile& file, const TimedPlan& row, double bound) {
    const double above = bound > 0.0 ? 100.0 * (row.plan.makespan / bound - 1.0) : 0.0;
    const std::string line = fmt::format("{:<10} {:>14.8g} {:>10.1f} % {:>9.1f} us  {}",
                                         row.plan.algorithm, file.unit.factor * row.plan.makespan,
                                         above, 1e6 * row.seconds, verdict(row.plan));
    return line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
}

}  // namespace

std::string frame_text(const TraceGraph& trace) {
    return fmt::format(
        "{}, frame {}: one of its {} substeps, {} tasks; strips per device: {}\n"
        "recorded     planned {} by {}, measured {} on average\n\n",
        trace.scene, trace.frame, trace.substeps, trace.file.graph.task_count(),
        fmt::join(trace.strips, ", "), time_text(trace.file, trace.planned), trace.planner,
        time_text(trace.file, trace.measured));
}

std::string plan_report(const GraphFile& file, const TimedPlan& result) {
    const Plan& plan = result.plan;
    const std::string part =
        plan.found_by == plan.algorithm ? "" : fmt::format(" (found by {})", plan.found_by);
    const std::string note = verdict(plan);
    return plan_table(file, plan) + '\n' + plan_gantt(file, plan) + '\n' +
           fmt::format("algorithm    {}{}\n", plan.algorithm, part) +
           fmt::format("makespan     {}{}\n", time_text(file, plan.makespan),
                       note.empty() ? "" : ", " + note) +
           fmt::format("lower bound  {} (path {}, area {})\n", time_text(file, plan.lower_bound()),
                       time_text(file, plan.path_bound), time_text(file, plan.area_bound)) +
           fmt::format("gap          {:.1f} %\n", 100.0 * plan.gap());
}

ordered_json plan_json(const GraphFile& file, const TimedPlan& result, const TraceGraph* trace) {
    ordered_json json = summary_json(result);
    if (trace != nullptr) json.update(frame_json(*trace));
    json["tasks"] = ordered_json::array();
    for (TaskId t = 0; t < file.graph.task_count(); ++t) {
        const scheduler::Placement& own = result.plan.placements[t];
        json["tasks"].push_back({{"name", file.graph.name(t)},
                                 {"processor", file.processors[own.processor]},
                                 {"start", own.start},
                                 {"end", own.end}});
    }
    return json;
}

std::string comparison_text(const GraphFile& file, const std::vector<TimedPlan>& rows) {
    const double bound = lower_bound(rows);
    const Plan& first = rows.front().plan;
    std::string text =
        fmt::format("{} tasks, {} edges, {} processors\n", file.graph.task_count(),
                    file.graph.edge_count(), file.processors.size()) +
        fmt::format("lower bound {} (path {}, area {})\n\n", time_text(file, bound),
                    time_text(file, first.path_bound), time_text(file, first.area_bound)) +
        fmt::format("{:<10} {:>14} {:>12} {:>12}\n", "algorithm",
                    file.unit.name.empty() ? "makespan" : "makespan [" + file.unit.name + "]",
                    "above bound", "planning");
    for (const TimedPlan& row : rows) text += comparison_row(file, row, bound);
    return text;
}

ordered_json comparison_json(const GraphFile& file, const std::vector<TimedPlan>& rows,
                             const TraceGraph* trace) {
    ordered_json json{{"processors", file.processors},
                      {"tasks", file.graph.task_count()},
                      {"edges", file.graph.edge_count()},
                      {"lower_bound", lower_bound(rows)},
                      {"rows", ordered_json::array()}};
    if (trace != nullptr) json.update(frame_json(*trace));
    for (const TimedPlan& row : rows) json["rows"].push_back(summary_json(row));
    return json;
}

}  // namespace weft
