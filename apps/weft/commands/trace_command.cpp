#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/weft/commands/commands.h"
#include "runtime/io/json_text.h"
#include "runtime/trace/trace_reader.h"
#include "simulation/output/summary_builder.h"

namespace weft {

namespace {

struct TraceOptions {
    std::string trace;
    bool json = false;
};

RunSummary summarise(const TraceReader& trace, const std::string& path) {
    SummaryBuilder builder(trace.run());
    for (const std::string& warning : trace.run().warnings) builder.warn(warning);
    for (const FrameRecord& frame : trace.frames()) {
        builder.add(frame);
        for (const std::string& warning : frame.warnings) {
            builder.warn(fmt::format("frame {}: {}", frame.frame, warning));
        }
    }
    RunSummary summary = builder.summary();
    summary.finished = trace.finished();
    summary.state_hash = trace.state_hash();
    summary.files = {{"trace", path}};
    return summary;
}

/// The cost model at the last frame: what the planner had learned about each kind on each device.
std::vector<CostRecord> last_costs(const TraceReader& trace) {
    if (trace.frames().empty()) return {};
    return trace.frame(trace.frames().size() - 1).costs;
}

std::string name_of(const std::vector<std::string>& names, std::size_t index) {
    return index < names.size() ? names[index] : fmt::format("#{}", index);
}

void print_json(const TraceReader& trace, const RunSummary& summary) {
    const RunDescription& run = trace.run();
    nlohmann::ordered_json json = to_json(summary);
    json["started"] = trace.started();
    json["costs"] = nlohmann::ordered_json::array();
    for (const CostRecord& cost : last_costs(trace)) {
        json["costs"].push_back({{"kind", name_of(run.kinds, cost.kind)},
                                 {"device", cost.device},
                                 {"fixed_s", cost.fixed},
                                 {"per_item_s", cost.per_item},
                                 {"samples", cost.samples}});
    }
    std::cout << json_text(json) << '\n';
}

std::string costs_text(const TraceReader& trace) {
    const std::vector<CostRecord> costs = last_costs(trace);
    if (costs.empty()) return {};
    std::string text = "\ncosts at the end\n";
    text += fmt::format("{:<24} {:>6} {:>12} {:>12} {:>9}\n", "kind", "device", "fixed [us]",
                        "item [ns]", "samples");
    for (const CostRecord& cost : costs) {
        text += fmt::format("{:<24} {:>6} {:>12.2f} {:>12.3f} {:>9}\n",
                            name_of(trace.run().kinds, cost.kind), cost.device, 1e6 * cost.fixed,
                            1e9 * cost.per_item, cost.samples);
    }
    return text;
}

void print_text(const TraceReader& trace, const RunSummary& summary) {
    const RunDescription& run = trace.run();
    std::cout << fmt::format("{:<16} {}\n", "command", run.command)
              << fmt::format("{:<16} {}{}\n", "started", trace.started(),
                             trace.finished() ? "" : "; not finished: going on, failed or killed");
    for (const TextPairs& pairs : {run.host, run.versions}) {
        for (const auto& [key, value] : pairs) std::cout << fmt::format("{:<16} {}\n", key, value);
    }
    std::cout << to_text(summary) << costs_text(trace);
}

void summarise_trace(const TraceOptions& options) {
    const TraceReader trace(options.trace);
    const RunSummary summary = summarise(trace, options.trace);
    if (options.json) {
        print_json(trace, summary);
    } else {
        print_text(trace, summary);
    }
}

}  // namespace

void add_trace_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("trace", "Read the trace of a run");
    command->require_subcommand(1);
    command->footer(
        "Examples:\n  weft trace summary out/tablecloth/trace.h5\n"
        "  weft trace gantt out/tablecloth/trace.h5 --frame 10 --out schedule.png\n"
        "  weft trace perfetto out/tablecloth/trace.h5");

    const auto options = std::make_shared<TraceOptions>();
    CLI::App* summary = command->add_subcommand(
        "summary",
        "Print what the run printed at its end; also of a run that goes on or was killed");
    summary->add_option("TRACE", options->trace, "trace.h5 of a run")->required();
    summary->add_flag("--json", options->json, "print one JSON document");
    summary->footer("Example:\n  weft trace summary out/tablecloth/trace.h5 --json");
    summary->callback([options] { summarise_trace(*options); });
    add_gantt_command(*command);
    add_perfetto_command(*command);
}

}  // namespace weft
