#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>

#include "apps/weft/batch/make_sweep.h"
#include "apps/weft/command_line/common_options.h"
#include "apps/weft/command_line/validators.h"
#include "apps/weft/commands/commands.h"
#include "apps/weft/commands/study_options.h"
#include "apps/weft/output/output_file.h"
#include "apps/weft/output/warnings.h"
#include "apps/weft/studies/error_report.h"
#include "apps/weft/studies/study_files.h"
#include "apps/weft/studies/study_parts.h"
#include "apps/weft/studies/study_sweep.h"
#include "apps/weft/studies/sweep_text.h"
#include "apps/weft/studies/trajectory_report.h"
#include "apps/weft/studies/trajectory_study.h"
#include "runtime/device_list.h"
#include "runtime/error.h"
#include "runtime/io/json_text.h"
#include "simulation/scene/method.h"

namespace weft {

namespace {

template <class Study>
void print_study(const ErrorOptions& options, const Study& study, const std::string& files) {
    if (options.run.json)
        std::cout << json_text(to_json(study)) << std::endl;
    else
        std::cout << to_text(study) << '\n' << files << std::endl;
}

Scene scene_of(const ErrorOptions& options) {
    return read_scene(options.run.scene, options.run.overrides());
}

/// study.json is for whoever joins the parts of a study.
template <class Study>
void run_study(const ErrorOptions& options, const Study& study,
               const std::filesystem::path& folder) {
    write_output(folder / "study.json", json_text(to_part(study), -1) + '\n');
    print_study(options, study, write_study(folder, study));
}

/// Wrong names are to be seen before there are jobs of them.
void check_names(const ErrorOptions& options) {
    RunOptions run = options.run;
    for (const std::string& solver : options.solvers) {
        run.solver = solver;
        read_scene(run.scene, run.overrides());
    }
    for (const std::string& plan : options.plans) {
        run.plan = plan;
        static_cast<void>(run.simulation());
    }
    for (const std::string& devices : options.devices) check_device_list(devices);
}

/// A sweep of its own, of runs that do a curve each.
void make_sweep_of(const ErrorOptions& options) {
    check_names(options);
    const Scene scene = scene_of(options);
    const std::string name = scene.name + (options.trajectory ? "-trajectory" : "-error");
    const std::filesystem::path folder = batch::sweep_folder(name, options.run.out);
    make_study_sweep(study_sweep(options, name, folder), folder, options.run);
}

void run_error(ErrorOptions options) {
    if (options.devices.empty()) options.devices = {hybrid_devices()};
    if (options.plans.empty()) options.plans = {"auto"};
    if (options.solvers.empty()) options.solvers = method_names();
    if (options.as_sweep) return make_sweep_of(options);
    if (!options.run.quiet) warn_of_cache_folder();
    const auto folder = make_output_folder(options.run.folder_for(scene_of(options).name));
    if (options.trajectory)
        run_study(options, study_trajectories(options), folder);
    else
        run_study(options, study_errors(options), folder);
}

void add_trajectory_options(CLI::App& command, ErrorOptions& options) {
    CLI::Option* flag = command.add_flag(
        "--trajectory", options.trajectory,
        "measure whole runs instead: substeps x iterations, against a run with far smaller steps");
    for (const char* other :
         {"--frame", "--start", "--substeps", "--max-iterations", "--obstacles", "--planes"}) {
        flag->excludes(command.get_option(other));
    }
    const auto add = [&](const char* name, auto& value, const char* help) {
        return command.add_option(name, value, help)->needs(flag)->check(whole_number());
    };
    add("--sweep-substeps", options.sweep_substeps, "substeps per frame, separated by commas")
        ->delimiter(',')
        ->capture_default_str();
    add("--sweep-iterations", options.sweep_iterations, "iterations, separated by commas")
        ->delimiter(',')
        ->capture_default_str();
    add("--max-work", options.max_work, "the most substeps times iterations of a run")
        ->capture_default_str();
    add("--reference-substeps", options.reference_substeps,
        "of the run that the others are compared with (8 times the most that are swept; with "
        "[contact] twice)");
}

}  // namespace

void add_error_options(CLI::App& command, ErrorOptions& options) {
    add_scene_options(command, options.run);
    add_device_options(command, options.run);
    add_crossing_option(command, options.run);
    add_talk_options(command, options.run);
    for (const char* single : {"--device", "--plan", "--solver", "--iterations", "--strips"}) {
        command.remove_option(command.get_option(single));
    }
    command
        .add_option("--frame", options.frame,
                    "the step is the first one of this frame (default: the middle of the run)")
        ->check(whole_number());
    command
        .add_option(
            "--start", options.start,
            "the step begins at the state in this file: a checkpoint (weft run "
            "--keep-checkpoint), or frames.vtkhdf, of which --frame says the frame (its last)")
        ->type_name("STATE");
    command
        .add_option("--solvers", options.solvers,
                    "solvers, separated by commas (all that can do the scene)")
        ->delimiter(',')
        ->check(one_of(method_names()));
    command.add_option("--devices", options.devices, "device lists, separated by commas (hybrid)")
        ->delimiter(',');
    command
        .add_option(
            "--plans", options.plans,
            "kinds of plans, separated by commas (auto); async with settings of its own, as "
            "in async:window=3+dropping=on")
        ->delimiter(',');
    command
        .add_option("--max-iterations", options.max_iterations, "iterations that a curve goes to")
        ->check(whole_number())
        ->capture_default_str();
    command
        .add_option("--time", options.time,
                    "seconds of measuring after which a curve has no further point (10; whole "
                    "runs: 60); the reference is not in it")
        ->check(zero_or_more());
    command.add_option("--out", options.run.out, "output folder; default: out/<scene name>")
        ->check(path_name());
    CLI::Option* as_sweep = command.add_flag(
        "--as-sweep", options.as_sweep,
        "measure nothing, but make a sweep of it, a run per curve, for weft batch");
    command
        .add_flag("--obstacles", options.obstacles,
                  "leave obstacles in the step; errors are then squared distances from where the "
                  "first solver ends")
        ->excludes(as_sweep);
    command
        .add_flag("--planes", options.planes,
                  "leave in the step the planes by which [contact] keeps surfaces apart; what they "
                  "hold back counts as error")
        ->excludes(as_sweep);
    add_trajectory_options(command, options);
}

void add_error_command(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("error", "Measure the error of solvers against their run time");
    const auto options = std::make_shared<ErrorOptions>();
    add_error_options(*command, *options);
    command->footer(
        "Every solver starts one step from the same state, and its energy E is compared with E*,\n"
        "the minimum by Newton's method in double precision: relative error = (E - E*)/(E0 - E*).\n"
        "A point is one whole step with so many iterations, timed without the evaluation of E, "
        "the\n"
        "median of three. Writes error.csv, error.h5, and a picture, error.svg and error.png (with "
        "cairo).\n"
        "With --trajectory, whole runs: the RMS distance of all vertices from a run with far "
        "smaller\n"
        "steps, and the Pareto front; trajectory.csv, .h5, .svg, .png. docs/solvers.md "
        "explains.\n\n"
        "Examples:\n"
        "  weft error scenes/flag.toml --solvers xpbd --devices cpu/1,cpu/1+opencl:0/1\n"
        "  weft error scenes/sheet.toml --devices cpu/1+opencl:0/1 --plans exact,async,single\n"
        "  weft run scenes/skirt.toml --frames 30 --keep-checkpoint\n"
        "  weft error scenes/skirt.toml --start out/skirt/checkpoint\n"
        "  weft error scenes/sheet.toml --trajectory --frames 20 --devices cpu/1\n"
        "  weft error scenes/flag.toml --devices cpu/1 --as-sweep      (docs/batch.md)");
    command->callback([options] { run_error(*options); });
}

}  // namespace weft
