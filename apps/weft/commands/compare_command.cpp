#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/weft/command_line/common_options.h"
#include "apps/weft/command_line/validators.h"
#include "apps/weft/commands/commands.h"
#include "apps/weft/output/output_file.h"
#include "apps/weft/output/progress.h"
#include "apps/weft/output/warnings.h"
#include "apps/weft/process/child_process.h"
#include "apps/weft/timing/comparison.h"
#include "runtime/device_list.h"
#include "runtime/io/json_text.h"
#include "simulation/choice/solver_choice.h"
#include "simulation/scene/auto_method.h"

namespace weft {

namespace {

/// Frames that do not count: caches fill, and the planner finds its balance.
constexpr int kWarmUp = 3;

struct CompareOptions {
    RunOptions run;
    std::vector<std::string> devices;
};

/// The devices of the mixture alone, the whole CPU, the mixture, and where that is more, what takes
/// turns with it as well.
std::vector<std::string> default_lists() {
    const std::string all = hybrid_devices();
    const std::string mixture = all.substr(0, all.find('|'));
    std::vector<std::string> lists = devices_of(mixture);
    if (std::find(lists.begin(), lists.end(), "cpu") == lists.end()) lists.emplace_back("cpu");
    if (devices_of(mixture).size() > 1) lists.push_back(mixture);
    if (all != mixture) lists.emplace_back("hybrid");
    return lists;
}

Comparison compare(const CompareOptions& options, const std::vector<std::string>& lists,
                   const Scene& scene) {
    // One after the other: each profiles its devices when it starts.
    std::vector<std::unique_ptr<FrameWorker>> workers;
    for (const std::string& list : lists) {
        RunOptions run = options.run;
        run.device = list;
        workers.push_back(std::make_unique<FrameWorker>(run));
        workers.back()->wait_until_ready();
    }
    std::vector<std::vector<FrameSample>> frames(workers.size());
    Progress progress("frame", scene.frames, options.run.quiet);
    for (int frame = 0; frame < scene.frames; ++frame) {
        for (std::size_t w = 0; w < workers.size(); ++w) frames[w].push_back(workers[w]->advance());
        progress.show(frame + 1);
    }

    std::vector<ComparisonRow> rows;
    for (std::size_t w = 0; w < workers.size(); ++w) {
        const int skipped = std::min(kWarmUp, scene.frames - 1);
        frames[w].erase(frames[w].begin(), frames[w].begin() + skipped);
        rows.push_back(make_row(lists[w], frames[w], workers[w]->end_state()));
    }
    return compare_rows(scene.name, std::move(rows));
}

void write_json(const std::filesystem::path& folder, const nlohmann::ordered_json& json) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    write_output(folder / "compare.json", json_text(json) + '\n');
}

/// Asynchronous plans have results of their own.
void warn_of_different_states(const Comparison& comparison) {
    const ComparisonRow* first = nullptr;
    for (const ComparisonRow& row : comparison.rows) {
        if (row.is_async) continue;
        if (first == nullptr) first = &row;
        if (row.state_hash == first->state_hash) continue;
        std::cerr << fmt::format(
            "weft: warning: {} ended in another state than {} (only --math fast, or a device that "
            "cannot round correctly, explains that)\n",
            row.devices, first->devices);
    }
}

/// One choice for all lists, made in a process of its own: this one is to have no threads yet.
void settle_solver(RunOptions& run, const Scene& scene) {
    if (!auto_method(scene)) return;
    const SolverChoice choice = parse_solver_choice(in_child_process("the choice of a solver", [&] {
        return to_text(choose_solver(scene, run.simulation().plan));
    }));
    run.solver = name_of(choice.method);
    run.iterations = std::to_string(choice.iterations);
    run.substeps = std::to_string(choice.substeps);
    if (run.quiet) return;
    std::cerr << fmt::format("weft: {}: solver {}: {}\n", scene.name, *run.solver, choice.why);
}

void run_comparison(CompareOptions options) {
    options.run.check_async();
    if (!options.run.quiet) warn_of_cache_folder();
    std::signal(SIGPIPE, SIG_IGN);  // a worker that ends early is reported by its last words
    const Scene scene = read_scene(options.run.scene, options.run.overrides());
    settle_solver(options.run, scene);
    const auto lists = options.devices.empty() ? default_lists() : options.devices;
    const Comparison comparison = compare(options, lists, scene);
    const nlohmann::ordered_json json = to_json(comparison);
    write_json(options.run.folder_for(scene.name), json);
    if (options.run.json)
        std::cout << json_text(json) << std::endl;
    else
        std::cout << to_text(comparison) << std::flush;
    print_warnings(comparison.warnings);
    warn_of_different_states(comparison);
}

}  // namespace

void add_compare_command(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("compare", "Time device lists side by side, frame by frame");
    const auto options = std::make_shared<CompareOptions>();
    add_scene_options(*command, options->run);
    add_device_options(*command, options->run);
    add_crossing_option(*command, options->run);
    add_talk_options(*command, options->run);
    command->remove_option(command->get_option("--device"));
    command->add_option("--devices", options->devices, "device lists, separated by commas")
        ->delimiter(',');
    command->add_option("--out", options->run.out, "folder of compare.json (out/<scene name>)")
        ->check(path_name());
    command->footer(
        "Every list runs in a process of its own, and they take turns frame by frame, so that a\n"
        "change of the machine's speed meets all alike. The first 3 frames do not count. A "
        "frame's\n"
        "time is all that it takes but output; planned and measured are makespans.\n"
        "efficiency = the mixture's speed / the sum of the speeds of its devices alone.\n"
        "Frames whose result is to be doubted are told, and go on.\n\n"
        "Example:\n"
        "  weft compare scenes/tablecloth.toml --devices cpu/1,opencl:0/1,cpu/2,cpu/1+opencl:0/1");
    command->callback([options] { run_comparison(*options); });
}

}  // namespace weft
