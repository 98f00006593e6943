#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/weft/command_line/validators.h"
#include "apps/weft/commands/commands.h"
#include "apps/weft/output/output_file.h"
#include "apps/weft/pictures/machine_picture.h"
#include "apps/weft/pictures/write_pictures.h"
#include "apps/weft/plan/adaptations.h"
#include "apps/weft/plan/cost_file.h"
#include "apps/weft/plan/graph_file.h"
#include "apps/weft/plan/plan_text.h"
#include "apps/weft/plan/trace_graph.h"
#include "apps/weft/studies/machine_study.h"
#include "runtime/error.h"
#include "runtime/io/json_text.h"
#include "scheduler/optimal.h"
#include "scheduler/planner.h"
#include "scheduler/portfolio.h"

namespace weft {
namespace {

using nlohmann::ordered_json;
using scheduler::Plan;
using scheduler::Planner;
using scheduler::TaskId;

// For one plan at leisure, unlike the runtime's one per frame.
constexpr std::uint32_t kPortfolioEvaluations = 20000;

struct PlanOptions {
    std::string graph;
    std::string algorithm = "portfolio";
    double time_limit = 10.0;  // s
    bool compare = false;
    bool json = false;
    Adaptations adaptations;
    // Of traces only.
    std::optional<std::uint32_t> frame;
    std::optional<std::string> costs;
    bool pinned = false;
    std::optional<std::string> strips;
    bool print_costs = false;
    bool machines = false;
    MachineGrid grid;
    std::optional<std::string> out;
};

struct TimedPlan {
    Plan plan;
    double seconds = 0.0;
};

std::vector<std::string> algorithm_names() {
    return {scheduler::planner_names().begin(), scheduler::planner_names().end()};
}

std::unique_ptr<Planner> planner_for(const std::string& name, double time_limit) {
    if (name == "optimal") {
        return std::make_unique<scheduler::Optimal>(
            scheduler::SearchLimit{.nodes = ~std::uint64_t{0}, .seconds = time_limit});
    }
    if (name == "portfolio") {
        return std::make_unique<scheduler::Portfolio>(scheduler::PortfolioBudget{
            .evaluations = kPortfolioEvaluations, .seconds = time_limit});
    }
    return scheduler::make_planner(name);
}

TimedPlan make_plan(const GraphFile& file, const std::string& algorithm, double time_limit) {
    TimedPlan result;
    const auto begin = std::chrono::steady_clock::now();
    planner_for(algorithm, time_limit)->plan(file.graph, result.plan);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    result.seconds = took.count();
    return result;
}

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

void print_json(const GraphFile& file, const TimedPlan& result, const TraceGraph* trace) {
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
    std::cout << json_text(json) << '\n';
}

std::string time_text(const GraphFile& file, double time) {
    return fmt::format("{:.8g}{}{}", file.unit.factor * time, file.unit.name.empty() ? "" : " ",
                       file.unit.name);
}

/// What is planned, and what became of it in the run.
void print_frame(const TraceGraph& trace) {
    std::cout << fmt::format(
        "{}, frame {}: one of its {} substeps, {} tasks; strips per device: {}\n"
        "recorded     planned {} by {}, measured {} on average\n\n",
        trace.scene, trace.frame, trace.substeps, trace.file.graph.task_count(),
        fmt::join(trace.strips, ", "), time_text(trace.file, trace.planned), trace.planner,
        time_text(trace.file, trace.measured));
}

void print_text(const GraphFile& file, const TimedPlan& result) {
    const Plan& plan = result.plan;
    std::cout << plan_table(file, plan) << '\n' << plan_gantt(file, plan) << '\n';
    const std::string part =
        plan.found_by == plan.algorithm ? "" : fmt::format(" (found by {})", plan.found_by);
    const std::string note = verdict(plan);
    std::cout << fmt::format("algorithm    {}{}\n", plan.algorithm, part)
              << fmt::format("makespan     {}{}\n", time_text(file, plan.makespan),
                             note.empty() ? "" : ", " + note)
              << fmt::format("lower bound  {} (path {}, area {})\n",
                             time_text(file, plan.lower_bound()), time_text(file, plan.path_bound),
                             time_text(file, plan.area_bound))
              << fmt::format("gap          {:.1f} %\n", 100.0 * plan.gap());
}

void print_comparison(const GraphFile& file, const PlanOptions& options, const TraceGraph* trace) {
    std::vector<TimedPlan> rows;
    for (const std::string& name : algorithm_names()) {
        rows.push_back(make_plan(file, name, options.time_limit));
    }
    double bound = 0.0;  // one row may prove more than the others
    for (const TimedPlan& row : rows) bound = std::max(bound, row.plan.lower_bound());
    if (options.json) {
        ordered_json json{{"processors", file.processors},
                          {"tasks", file.graph.task_count()},
                          {"edges", file.graph.edge_count()},
                          {"lower_bound", bound},
                          {"rows", ordered_json::array()}};
        if (trace != nullptr) json.update(frame_json(*trace));
        for (const TimedPlan& row : rows) json["rows"].push_back(summary_json(row));
        std::cout << json_text(json) << '\n';
        return;
    }
    const Plan& first = rows.front().plan;
    std::cout << fmt::format("{} tasks, {} edges, {} processors\n", file.graph.task_count(),
                             file.graph.edge_count(), file.processors.size())
              << fmt::format("lower bound {} (path {}, area {})\n\n", time_text(file, bound),
                             time_text(file, first.path_bound), time_text(file, first.area_bound))
              << fmt::format(
                     "{:<10} {:>14} {:>12} {:>12}\n", "algorithm",
                     file.unit.name.empty() ? "makespan" : "makespan [" + file.unit.name + "]",
                     "above bound", "planning");
    for (const TimedPlan& row : rows) {
        const double above = bound > 0.0 ? 100.0 * (row.plan.makespan / bound - 1.0) : 0.0;
        const std::string line = fmt::format(
            "{:<10} {:>14.8g} {:>10.1f} % {:>9.1f} us  {}", row.plan.algorithm,
            file.unit.factor * row.plan.makespan, above, 1e6 * row.seconds, verdict(row.plan));
        std::cout << line.substr(0, line.find_last_not_of(' ') + 1) << '\n';
    }
}

/// trace: null for a graph that is none's.
void plan_graph(GraphFile& file, const PlanOptions& options, const TraceGraph* trace) {
    adapt(file.graph, options.adaptations);
    if (trace != nullptr && !options.json) print_frame(*trace);
    if (options.compare) return print_comparison(file, options, trace);
    const TimedPlan result = make_plan(file, options.algorithm, options.time_limit);
    if (options.json) {
        print_json(file, result, trace);
    } else {
        print_text(file, result);
    }
}

/// By its name, so that a missing one is called by what it is; or by the signature of HDF5.
bool is_trace(const std::string& path) {
    if (std::filesystem::path(path).extension() == ".h5") return true;
    char signature[4] = {};
    std::ifstream(path, std::ios::binary).read(signature, sizeof(signature));
    return std::string_view(signature, sizeof(signature)) == "\x89HDF";
}

void refuse_trace_options(const PlanOptions& options) {
    const auto refuse = [&](bool given, const char* option) {
        if (!given) return;
        throw UserError(
            fmt::format("{}: is for traces (.h5); {} is a task graph", option, options.graph));
    };
    refuse(options.frame.has_value(), "--frame");
    refuse(options.costs.has_value(), "--costs");
    refuse(options.pinned, "--pinned");
    refuse(options.strips.has_value(), "--strips");
    refuse(options.print_costs, "--print-costs");
    refuse(options.machines, "--machines");
}

/// Beside the trace, unless it is said where.
std::filesystem::path map_folder(const PlanOptions& options) {
    if (!options.out) return std::filesystem::path(options.graph).parent_path();
    return make_output_folder(*options.out);
}

void map_machines(const PlanOptions& options) {
    const std::filesystem::path folder = map_folder(options);
    const MachineStudy study =
        study_machines(options.graph, options.frame, options.grid, options.json);
    write_output(folder / "machines.csv", to_csv(study));
    const std::string pictures = write_pictures(folder, "machines", MachinePicture(study));
    if (options.json) {
        std::cout << json_text(to_json(study)) << '\n';
    } else {
        std::cout << to_text(study)
                  << fmt::format("\n{}: machines.csv, {}\n", folder.empty() ? "." : folder.string(),
                                 pictures);
    }
}

void plan_file(const PlanOptions& options) {
    if (!is_trace(options.graph)) {
        refuse_trace_options(options);
        GraphFile file = read_graph_file(options.graph);
        return plan_graph(file, options, nullptr);
    }
    if (options.machines) return map_machines(options);
    TraceGraph trace = read_trace_graph(
        {options.graph, options.frame, options.costs, options.strips, options.pinned});
    if (options.print_costs) {
        std::cout << json_text(to_json(trace.costs, trace.kinds)) << '\n';
        return;
    }
    plan_graph(trace.file, options, &trace);
}

void add_adaptation_options(CLI::App& command, Adaptations& adaptations) {
    const std::string group = "Adaptations of the paper, to tasks of a kind and of an iteration";
    command
        .add_option("--merge", adaptations.merge,
                    "merge consecutive tasks of one kind and iteration until their average cost is "
                    "TIME; in a trace, seconds")
        ->type_name("TIME")
        ->check(above_zero())
        ->group(group);
    command
        .add_option("--open-iterations", adaptations.open_iterations,
                    "an iteration begins when all but the last N - 1 before it have ended; 1 is a "
                    "barrier after each, the paper has 2; default: as the tasks depend")
        ->type_name("N")
        ->check(CLI::Range(1, 1'000'000'000))
        ->group(group);
}

void add_machine_options(CLI::App& command, PlanOptions& options) {
    const std::string group = "Machines that need not be there";
    CLI::Option* machines = command.add_flag(
        "--machines", options.machines,
        "which of single, exact, placed and async takes least to the error that the trace's "
        "iterations reach, over the machines below; machines.csv, .svg and .png");
    machines->group(group);
    for (const char* other : {"--costs", "--pinned", "--strips", "--print-costs", "--compare"}) {
        machines->excludes(command.get_option(other));
    }
    const auto add = [&](const char* name, auto& values, const char* help) {
        return command.add_option(name, values, help)
            ->delimiter(',')
            ->needs(machines)
            ->capture_default_str()
            ->group(group);
    };
    add("--waits", options.grid.waits, "seconds from a task's end to one on another device")
        ->check(CLI::Range(0.0, 10.0));
    add("--ratios", options.grid.ratios, "how many times as fast every second device is")
        ->check(CLI::Range(1.0, 1e6));
    add("--device-counts", options.grid.devices, "numbers of devices")->check(CLI::Range(2, 16));
    command.add_option("--out", options.out, "folder; default: the trace's")
        ->check(path_name())
        ->type_name("DIR")
        ->needs(machines)
        ->group(group);
}

}  // namespace

void add_plan_command(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("plan", "Schedule a task graph, or a recorded frame, on any processors");
    command->footer(
        "GRAPH.json holds processors, tasks with their cost on each, and edges with the time that\n"
        "their data take from one processor to another:\n"
        "  {\"processors\": [\"cpu\", \"gpu\"],\n"
        "   \"tasks\": [{\"name\": \"a\", \"cost\": [14, 16]}, {\"name\": \"b\", \"cost\": [13, "
        "null]}],\n"
        "   \"edges\": [[\"a\", \"b\", 18]]}\n"
        "A task may have a \"kind\" and an \"iteration\" (whole numbers) for --merge,\n"
        "--open-iterations and heft-gs.\n\n"
        "A trace (.h5) gives one substep of a recorded frame, with the costs that it was planned "
        "with\n"
        "or with those of another machine; docs/traces.md describes the file of --costs.\n\n"
        "Examples:\n"
        "  weft plan graph.json --compare\n"
        "  weft plan graph.json --algorithm heft-gs --open-iterations 2\n"
        "  weft plan out/flag/trace.h5 --frame 20 --algorithm in-order --pinned\n"
        "  weft plan out/flag/trace.h5 --frame 20 --print-costs >costs.json   # edit, then:\n"
        "  weft plan out/flag/trace.h5 --frame 20 --costs costs.json --strips auto --pinned\n"
        "  weft plan out/flag/trace.h5 --frame 20 --machines --device-counts 2,4");
    const auto options = std::make_shared<PlanOptions>();
    command->add_option("GRAPH", options->graph, "task graph (.json), or trace of a run (.h5)")
        ->required()
        ->type_name("FILE");
    const std::vector<std::string> names = algorithm_names();
    command
        ->add_option("--algorithm", options->algorithm, fmt::format("{}", fmt::join(names, ", ")))
        ->type_name("NAME")
        ->check(one_of(names))
        ->capture_default_str();
    command->add_flag("--compare", options->compare,
                      "a table of all algorithms, whatever --algorithm says");
    command
        ->add_option("--time-limit", options->time_limit,
                     "seconds after which portfolio and optimal settle for the best plan so far")
        ->type_name("SECONDS")
        ->check(above_zero())
        ->capture_default_str();
    command->add_flag("--json", options->json, "print one JSON document");
    add_adaptation_options(*command, options->adaptations);
    const std::string group = "Traces";
    command->add_option("--frame", options->frame, "number of the frame; default: the last one")
        ->type_name("N")
        ->group(group);
    command
        ->add_option("--costs", options->costs, "plan with the costs in this file (.json) instead")
        ->type_name("FILE")
        ->group(group);
    command
        ->add_flag("--pinned", options->pinned,
                   "each task stays on the device that was given its strips")
        ->group(group);
    command
        ->add_option("--strips", options->strips,
                     "divide the strips anew: auto finds the best division, N,N gives each device "
                     "so many; default: as in the run")
        ->type_name("auto|N,N")
        ->group(group);
    command
        ->add_flag("--print-costs", options->print_costs,
                   "print the costs as a file for --costs, and stop")
        ->group(group);
    add_machine_options(*command, *options);
    command->callback([options] {
        try {
            plan_file(*options);
        } catch (const scheduler::GraphError& error) {  // what a planner or adaptation refuses
            throw UserError(fmt::format("{}: {}", options->graph, error.what()));
        }
    });
}

}  // namespace weft
