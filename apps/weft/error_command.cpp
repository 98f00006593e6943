#include <filesystem>
#include <iostream>
#include <memory>

#include "apps/weft/commands.h"
#include "apps/weft/error_picture.h"
#include "apps/weft/error_report.h"
#include "apps/weft/trace_support.h"
#include "runtime/device_list.h"
#include "runtime/error.h"

namespace weft {

namespace {

void write_whole(const std::filesystem::path& path, const std::string& content) {
    WholeFile file(path);
    file.write(content);
    file.finish();
}

/// folder/error.svg, and error.png where there is cairo. What was written, for people.
std::string write_pictures(const std::filesystem::path& folder, const ErrorStudy& study) {
    const ErrorPicture picture(study);
    const auto write = [&](std::unique_ptr<Canvas> canvas, const char* name) {
        picture.draw(*canvas);
        write_whole(folder / name, canvas->finish());
    };
    write(make_svg_canvas(picture.width(), picture.height()), "error.svg");
    auto png = make_png_canvas(picture.width(), picture.height());
    if (!png) return "error.svg (no error.png: this weft was built without cairo)";
    write(std::move(png), "error.png");
    return "error.svg, error.png";
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

void run_error(ErrorOptions options) {
    if (options.devices.empty()) options.devices = {hybrid_devices()};
    if (options.plans.empty()) options.plans = {"auto"};
    if (options.solvers.empty()) options.solvers = method_names();
    const std::filesystem::path folder = make_folder(options);
    const ErrorStudy study = study_errors(options);
    write_whole(folder / "error.csv", to_csv(study));
    write_error_file(folder / "error.h5", study);
    const std::string pictures = write_pictures(folder, study);
    if (options.run.json) {
        std::cout << to_json(study).dump(2) << std::endl;
    } else {
        std::cout << to_text(study) << "\n"
                  << folder.string() << ": error.csv, error.h5, " << pictures << std::endl;
    }
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
    command
        ->add_option("--time", options->time,
                     "seconds after which a curve measures no further point")
        ->capture_default_str();
    command->add_option("--out", options->run.out, "output folder; default: out/<scene name>");
    command->footer(
        "Every solver starts one step from the same state, and its energy E is compared with E*,\n"
        "the minimum by Newton's method in double precision: relative error = (E - E*)/(E0 - E*).\n"
        "A point is one whole step with so many iterations, timed without the evaluation of E, "
        "the\n"
        "median of three. Writes error.csv, error.h5, and a picture, error.svg and error.png (with "
        "cairo).\n"
        "docs/solvers.md explains.\n\n"
        "Example:\n"
        "  weft error scenes/flag.toml --solvers xpbd --devices cpu/1,cpu/1+opencl:0/1");
    command->callback([options] { run_error(*options); });
}

}  // namespace weft
