#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/weft/cli_support.h"
#include "apps/weft/commands.h"
#include "apps/weft/output_file.h"
#include "apps/weft/pictures/stability_picture.h"
#include "apps/weft/pictures/write_pictures.h"
#include "apps/weft/progress.h"
#include "apps/weft/studies/stability/recommend.h"
#include "apps/weft/studies/stability/report.h"
#include "runtime/error.h"
#include "simulation/scene/near_miss.h"

namespace weft {

namespace {

struct StabilityOptions {
    RunOptions run;
    std::vector<std::string> solvers;  ///< empty: all
    std::string only;                  ///< words in group or name
    bool is_short = false;
    double time = 300.0;  ///< [s] of trying settings of a scene
};

void check_solvers(const std::vector<std::string>& solvers) {
    const auto known = method_names();
    for (const std::string& solver : solvers) {
        if (std::ranges::find(known, solver) != known.end()) continue;
        throw UserError(
            fmt::format("--solvers: no solver '{}'; {}", solver, near_miss_or_list(solver, known)));
    }
}

std::vector<stability::Case> chosen_cases(const StabilityOptions& options) {
    std::vector<stability::Case> cases = stability::all_cases();
    std::erase_if(cases, [&](const stability::Case& c) {
        const bool is_named = (c.group + ": " + c.name).find(options.only) != std::string::npos;
        return (options.is_short && !c.in_short) || !is_named;
    });
    if (cases.empty()) throw UserError("--only: no case has '" + options.only + "' in its name");
    return cases;
}

std::filesystem::path make_folder(const RunOptions& options) {
    const std::filesystem::path folder = options.out.value_or("out/stability");
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw UserError("--out: cannot make " + folder.string() + ": " + error.message());
    return folder;
}

std::vector<stability::Row> run_suite(const StabilityOptions& options) {
    const auto cases = chosen_cases(options);
    std::vector<stability::Row> rows;
    Progress progress("case", static_cast<int>(cases.size() * options.solvers.size()),
                      options.run.quiet);
    for (const stability::Case& what : cases) {
        for (const std::string& solver : options.solvers) {
            rows.push_back({what, stability::run_case(what, solver, options.run)});
            progress.show(static_cast<int>(rows.size()));
        }
    }
    return rows;
}

void show_suite(const StabilityOptions& options) {
    const auto folder = make_folder(options.run);
    const auto rows = run_suite(options);
    write_output(folder / "stability.csv", to_csv(rows));
    std::string files = folder.string() + ": stability.csv";
    files += ", " + write_pictures(folder, "stability", StabilityPicture(rows));
    if (options.run.json)
        std::cout << to_json(rows).dump(2) << std::endl;
    else
        std::cout << to_text(rows) << files << std::endl;
    const auto silent = std::ranges::count_if(
        rows, [](const stability::Row& row) { return row.outcome.is_silent(); });
    if (silent > 0) {
        throw RunError(fmt::format("{} of {} runs were wrong without a word", silent, rows.size()));
    }
}

void show_advice(const StabilityOptions& options) {
    const auto advice = stability::advise(options.run, options.solvers, options.time);
    if (options.run.json)
        std::cout << to_json(advice).dump(2) << std::endl;
    else
        std::cout << to_text(advice) << std::flush;
    if (!advice.cheapest) throw RunError("no setting was found that holds");
}

void run_stability(StabilityOptions options) {
    check_solvers(options.solvers);
    if (options.solvers.empty()) options.solvers = method_names();
    if (options.run.scene.empty()) return show_suite(options);
    show_advice(options);
}

}  // namespace

void add_stability_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "stability", "Show what stays stable, or find settings that hold for a scene");
    const auto options = std::make_shared<StabilityOptions>();
    options->run.device = "cpu/1";
    add_scene_options(*command, options->run);
    add_device_options(*command, options->run);
    add_crossing_option(*command, options->run);
    add_talk_options(*command, options->run);
    for (const char* other : {"--solver", "--substeps", "--iterations", "--strips"}) {
        command->remove_option(command->get_option(other));
    }
    command->get_option("SCENE")->required(false);
    command->add_option("--solvers", options->solvers, "solvers, separated by commas (all)")
        ->delimiter(',');
    command->add_flag("--short", options->is_short, "only the cases of the test suite");
    command->add_option("--only", options->only, "only cases with this in 'group: name'");
    command->add_option("--time", options->time, "seconds of trying settings of a scene")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_option("--out", options->run.out, "output folder; default: out/stability");
    command->footer(
        "Without a scene: runs the shipped suite of stiff and extreme cases by every solver, and\n"
        "writes stability.csv and a picture, stability.svg and stability.png (with cairo). A run "
        "is\n"
        "stable, dissipated, unconverged, exploded or stopped, by each case's written criterion.\n"
        "Exit code 1 if one was wrong without a word.\n\n"
        "With a scene: tries solvers, iterations and substeps, and recommends the cheapest that "
        "hold.\ndocs/stability.md explains.\n\n"
        "Examples:\n"
        "  weft stability --solvers vbd --only stiffness\n"
        "  weft stability scenes/sheet.toml --frames 20 --time 60");
    command->callback([options] { run_stability(*options); });
}

}  // namespace weft
