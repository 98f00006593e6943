#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>

#include "apps/weft/cli_support.h"
#include "apps/weft/commands.h"
#include "apps/weft/error_picture.h"
#include "apps/weft/error_report.h"
#include "apps/weft/trace_support.h"
#include "apps/weft/trajectory_picture.h"
#include "apps/weft/trajectory_report.h"
#include "apps/weft/trajectory_study.h"
#include "runtime/device_list.h"
#include "runtime/error.h"

namespace weft {

namespace {

void write_whole(const std::filesystem::path& path, const std::string& content) {
    WholeFile file(path);
    file.write(content);
    file.finish();
}

/// folder/name.svg, and name.png where there is cairo. What was written, for people.
template <class Picture>
std::string write_pictures(const std::filesystem::path& folder, const std::string& name,
                           const Picture& picture) {
    const auto write = [&](std::unique_ptr<Canvas> canvas, const std::string& file) {
        picture.draw(*canvas);
        write_whole(folder / file, canvas->finish());
    };
    write(make_svg_canvas(picture.width(), picture.height()), name + ".svg");
    auto png = make_png_canvas(picture.width(), picture.height());
    if (!png) return fmt::format("{0}.svg (no {0}.png: this weft was built without cairo)", name);
    write(std::move(png), name + ".png");
    return fmt::format("{0}.svg, {0}.png", name);
}

template <class Study>
void print_study(const ErrorOptions& options, const Study& study, const std::string& files) {
    if (options.run.json)
        std::cout << to_json(study).dump(2) << std::endl;
    else
        std::cout << to_text(study) << '\n' << files << std::endl;
}

std::filesystem::path make_folder(const ErrorOptions& options) {
    const Scene scene = read_scene(options.run.scene, options.run.overrides());
    const std::filesystem::path folder = options.run.out
                                             ? std::filesystem::path(*options.run.out)
                                             : std::filesystem::path("out") / scene.name;
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw UserError("--out: cannot make " + folder.string() + ": " + error.message());
    return folder;
}

void run_one_step(const ErrorOptions& options, const std::filesystem::path& folder) {
    const ErrorStudy study = study_errors(options);
    write_whole(folder / "error.csv", to_csv(study));
    write_error_file(folder / "error.h5", study);
    const std::string pictures = write_pictures(folder, "error", ErrorPicture(study));
    print_study(options, study, folder.string() + ": error.csv, error.h5, " + pictures);
}

void run_trajectories(const ErrorOptions& options, const std::filesystem::path& folder) {
    const TrajectoryStudy study = study_trajectories(options);
    write_whole(folder / "trajectory.csv", to_csv(study));
    write_trajectory_file(folder / "trajectory.h5", study);
    const std::string pictures = write_pictures(folder, "trajectory", TrajectoryPicture(study));
    print_study(options, study, folder.string() + ": trajectory.csv, trajectory.h5, " + pictures);
}

void run_error(ErrorOptions options) {
    if (options.devices.empty()) options.devices = {hybrid_devices()};
    if (options.plans.empty()) options.plans = {"auto"};
    if (options.solvers.empty()) options.solvers = method_names();
    const std::filesystem::path folder = make_folder(options);
    if (options.trajectory)
        run_trajectories(options, folder);
    else
        run_one_step(options, folder);
}

void add_trajectory_options(CLI::App& command, ErrorOptions& options) {
    CLI::Option* flag = command.add_flag(
        "--trajectory", options.trajectory,
        "measure whole runs instead: substeps x iterations, against a run with far smaller steps");
    for (const char* other : {"--frame", "--substeps", "--max-iterations"}) {
        flag->excludes(command.get_option(other));
    }
    const auto add = [&](const char* name, auto& value, const char* help) {
        CLI::Option* option = command.add_option(name, value, help);
        option->needs(flag);
        return option;
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
        "of the run that the others are compared with (8 times the most that are swept)");
}

}  // namespace

void add_error_command(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("error", "Measure the error of solvers against their run time");
    const auto options = std::make_shared<ErrorOptions>();
    add_scene_options(*command, options->run);
    add_device_options(*command, options->run);
    add_talk_options(*command, options->run);
    for (const char* single : {"--device", "--plan", "--solver", "--iterations", "--strips"}) {
        command->remove_option(command->get_option(single));
    }
    command->add_option("--frame", options->frame,
                        "the step is the first one of this frame (default: the middle of the run)");
    command->add_option("--solvers", options->solvers, "solvers, separated by commas (all)")
        ->delimiter(',');
    command->add_option("--devices", options->devices, "device lists, separated by commas (hybrid)")
        ->delimiter(',');
    command->add_option("--plans", options->plans, "kinds of plans, separated by commas (auto)")
        ->delimiter(',');
    command
        ->add_option("--max-iterations", options->max_iterations, "iterations that a curve goes to")
        ->capture_default_str();
    command->add_option("--time", options->time,
                        "seconds after which a curve measures no further point (10; whole runs: "
                        "60)");
    command->add_option("--out", options->run.out, "output folder; default: out/<scene name>");
    add_trajectory_options(*command, *options);
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
        "  weft error scenes/sheet.toml --trajectory --frames 20 --devices cpu/1");
    command->callback([options] { run_error(*options); });
}

}  // namespace weft
