#include <fmt/format.h>
#include <fmt/ranges.h>

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
#include "apps/weft/plan/plan_report.h"
#include "apps/weft/plan/timed_plan.h"
#include "apps/weft/plan/trace_graph.h"
#include "apps/weft/studies/machine_study.h"
#include "runtime/error.h"
#include "runtime/io/json_text.h"

namespace weft {
namespace {

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

void print_plan(const GraphFile& file, const PlanOptions& options, const TraceGraph* trace) {
    const TimedPlan result = make_plan(file, options.algorithm, options.time_limit);
    std::cout << (options.json ? json_text(plan_json(file, result, trace)) + '\n'
                               : plan_report(file, result));
}

void print_comparison(const GraphFile& file, const PlanOptions& options, const TraceGraph* trace) {
    std::vector<TimedPlan> rows;
    for (const std::string& name : algorithm_names()) {
        rows.push_back(make_plan(file, name, options.time_limit));
    }
    std::cout << (options.json ? json_text(comparison_json(file, rows, trace)) + '\n'
                               : comparison_text(file, rows));
}

/// trace: null for a graph that is none's.
void plan_graph(GraphFile& file, const PlanOptions& options, const TraceGraph* trace) {
    adapt(file.graph, options.adaptations);
    if (trace != nullptr && !options.json) std::cout << frame_text(*trace);
    if (options.compare) {
        print_comparison(file, options, trace);
    } else {
        print_plan(file, options, trace);
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

void add_trace_options(CLI::App& command, PlanOptions& options) {
    const std::string group = "Traces";
    command.add_option("--frame", options.frame, "number of the frame; default: the last one")
        ->type_name("N")
        ->check(whole_number(0))
        ->group(group);
    command
        .add_option("--costs", options.costs, "plan with the costs in this file (.json) instead")
        ->type_name("FILE")
        ->group(group);
    command
        .add_flag("--pinned", options.pinned,
                  "each task stays on the device that was given its strips")
        ->group(group);
    command
        .add_option("--strips", options.strips,
                    "divide the strips anew: auto finds the best division, N,N gives each device "
                    "so many; default: as in the run")
        ->type_name("auto|N,N")
        ->group(group);
    command
        .add_flag("--print-costs", options.print_costs,
                  "print the costs as a file for --costs, and stop")
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
    add_trace_options(*command, *options);
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
