#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/weft/batch/make_sweep.h"
#include "apps/weft/command_line/common_options.h"
#include "apps/weft/command_line/validators.h"
#include "apps/weft/commands/commands.h"
#include "apps/weft/commands/study_options.h"
#include "apps/weft/output/output_file.h"
#include "apps/weft/output/progress.h"
#include "apps/weft/output/warnings.h"
#include "apps/weft/studies/stability/parts.h"
#include "apps/weft/studies/stability/recommend.h"
#include "apps/weft/studies/stability/report.h"
#include "apps/weft/studies/stability/stability_study.h"
#include "apps/weft/studies/study_files.h"
#include "apps/weft/studies/sweep_text.h"
#include "runtime/error.h"
#include "runtime/io/json_text.h"

namespace weft {

namespace {

using stability::StudyOptions;

std::vector<stability::Row> run_suite(const StudyOptions& options) {
    const auto cases = stability::chosen_cases(options);
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

/// study.json is for whoever joins the parts of a study.
template <class Study>
std::string write_files(const std::filesystem::path& folder, const Study& study) {
    write_output(make_output_folder(folder) / "study.json", json_text(to_part(study), -1) + '\n');
    return write_study(folder, study);
}

void show_suite(const StudyOptions& options) {
    const auto folder = make_output_folder(options.run.out.value_or("out/stability"));
    const auto rows = run_suite(options);
    const std::string files = write_files(folder, rows);
    if (options.run.json)
        std::cout << json_text(to_json(rows)) << std::endl;
    else
        std::cout << to_text(rows) << files << std::endl;
    const auto silent = std::ranges::count_if(
        rows, [](const stability::Row& row) { return row.outcome.is_silent(); });
    if (silent > 0) {
        throw RunError(fmt::format("{} of {} runs were wrong without a word", silent, rows.size()));
    }
}

void show_advice(const StudyOptions& options) {
    const auto advice = stability::advise(options.run, options.solvers, options.time);
    if (options.run.json)
        std::cout << json_text(to_json(advice)) << std::endl;
    else
        std::cout << to_text(advice) << std::flush;
    if (options.run.out) write_files(*options.run.out, advice);
    if (!advice.cheapest) throw RunError("no setting was found that holds");
}

/// What does not fit together would be left out without a word.
void check_uses(const StudyOptions& options) {
    options.run.check_async();
    const bool chooses = options.is_short || !options.only.empty() || !options.one_case.empty();
    if (options.run.scene.empty() && !options.run.overrides().empty())
        throw UserError("--set and --frames are for a scene; the suite's cases are as they are");
    if (!options.run.scene.empty() && chooses)
        throw UserError("--short, --only and --case are of the suite; with a scene there is none");
}

void make_sweep_of(const StudyOptions& options) {
    std::string name = "stability";
    if (!options.run.scene.empty())
        name = read_scene(options.run.scene, options.run.overrides()).name + "-settings";
    const std::filesystem::path folder = batch::sweep_folder(name, options.run.out);
    make_study_sweep(sweep_text(options, name, folder), folder, options.run);
}

void run_stability(StudyOptions options) {
    check_uses(options);
    if (options.solvers.empty()) options.solvers = method_names();
    if (options.as_sweep) return make_sweep_of(options);
    if (!options.run.quiet) warn_of_cache_folder();
    if (options.run.scene.empty()) return show_suite(options);
    show_advice(options);
}

}  // namespace

void add_stability_options(CLI::App& command, StudyOptions& options) {
    options.run.device = "cpu/1";
    add_scene_options(command, options.run);
    add_device_options(command, options.run);
    add_crossing_option(command, options.run);
    add_talk_options(command, options.run);
    for (const char* other : {"--solver", "--substeps", "--iterations", "--strips"}) {
        command.remove_option(command.get_option(other));
    }
    command.get_option("SCENE")->required(false);
    command.add_option("--solvers", options.solvers, "solvers, separated by commas (all)")
        ->delimiter(',')
        ->check(one_of(method_names()));
    command.add_flag("--short", options.is_short, "only the cases of the test suite");
    CLI::Option* only =
        command.add_option("--only", options.only, "only cases with this in 'group: name'");
    command.add_option("--case", options.one_case, "only the case with this 'group: name'")
        ->excludes(only);
    command.add_option("--time", options.time, "seconds of trying settings of a scene")
        ->check(above_zero())
        ->capture_default_str();
    command
        .add_option("--out", options.run.out,
                    "output folder; default: out/stability; with a scene: none")
        ->check(path_name());
    command.add_flag("--as-sweep", options.as_sweep,
                     "run nothing, but make a sweep of it, for weft batch");
}

void add_stability_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "stability", "Show what stays stable, or find settings that hold for a scene");
    const auto options = std::make_shared<StudyOptions>();
    add_stability_options(*command, *options);
    command->footer(
        "Without a scene: runs the shipped suite of stiff and extreme cases by every solver, and\n"
        "writes stability.csv and a picture, stability.svg and stability.png (with cairo). A run "
        "is\n"
        "stable, dissipated, unconverged, exploded or stopped, by each case's written criterion.\n"
        "Exit code 1 if one was wrong without a word.\n\n"
        "With a scene: tries solvers, iterations and substeps, and recommends the cheapest that "
        "hold;\nwith --out, settings.csv has all trials. docs/stability.md explains.\n\n"
        "Examples:\n"
        "  weft stability --solvers vbd --only stiffness\n"
        "  weft stability scenes/sheet.toml --frames 20 --time 60\n"
        "  weft stability --as-sweep                        (docs/batch.md)");
    command->callback([options] { run_stability(*options); });
}

}  // namespace weft
