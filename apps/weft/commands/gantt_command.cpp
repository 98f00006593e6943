#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "apps/weft/command_line/validators.h"
#include "apps/weft/commands/commands.h"
#include "apps/weft/output/output_file.h"
#include "apps/weft/pictures/gantt.h"
#include "apps/weft/trace/recorded_frames.h"
#include "runtime/error.h"

namespace weft {

namespace {

struct GanttOptions {
    std::string trace;
    std::optional<std::uint32_t> frame;
    std::uint32_t substep = 0;
    std::optional<std::string> iterations;
    std::optional<std::string> out;
};

/// Beside the trace: trace-frame12-substep0.svg, or trace-frame12-substep0-iterations2-3.svg.
std::filesystem::path picture_path(const GanttOptions& options, std::uint32_t frame,
                                   const GanttPart& part) {
    if (options.out) return *options.out;
    const std::string iterations =
        part.iterations
            ? fmt::format("-iterations{}-{}", part.iterations->first, part.iterations->second)
            : "";
    std::filesystem::path path = options.trace;
    path.replace_filename(fmt::format("{}-frame{}-substep{}{}.svg", path.stem().string(), frame,
                                      part.substep, iterations));
    return path;
}

using CanvasMaker = std::unique_ptr<Canvas> (*)(double width, double height);

CanvasMaker canvas_for(const std::filesystem::path& path) {
    const std::string ending = path.extension().string();
    if (ending == ".svg") return make_svg_canvas;
    if (ending != ".png") {
        throw UserError(
            fmt::format("--out {}: expected a name that ends in .svg or .png", path.string()));
    }
    if (make_png_canvas(1.0, 1.0)) return make_png_canvas;
    throw UserError(
        fmt::format("--out {}: this weft was built without cairo, which writes PNG; "
                    "write .svg instead",
                    path.string()));
}

/// An end that is left out is the frame's.
std::pair<std::uint32_t, std::uint32_t> iterations_of(const std::string& text,
                                                      const FrameRecord& frame) {
    const NumberRange range = parse_range(text, "--iterations", "iteration");
    if (range.last != NumberRange{}.last) return {range.first, range.last};
    std::uint32_t last = range.first;
    for (const PlanRecord& task : frame.plan) last = std::max(last, task.iteration);
    return {range.first, last};
}

GanttPart part_of(const GanttOptions& options, const FrameRecord& frame) {
    GanttPart part{options.substep, std::nullopt};
    if (options.iterations) part.iterations = iterations_of(*options.iterations, frame);
    return part;
}

Gantt make_gantt(const GanttOptions& options, const RunDescription& run, const FrameRecord& frame,
                 const GanttPart& part) {
    try {
        return Gantt(run, frame, part);
    } catch (const UserError& error) {
        throw UserError(options.trace + ": " + error.what());
    }
}

void draw_gantt(const GanttOptions& options) {
    const TraceReader trace(options.trace);
    const FrameRecord frame = trace.frame(find_frame(trace, options.trace, options.frame));
    const GanttPart part = part_of(options, frame);
    const std::filesystem::path path = picture_path(options, frame.frame, part);
    const CanvasMaker make_canvas = canvas_for(path);
    const Gantt gantt = make_gantt(options, trace.run(), frame, part);
    const auto canvas = make_canvas(gantt.width(), gantt.height());
    gantt.draw(*canvas);
    write_output(path, canvas->finish());
    std::cout << path.string() << '\n';
}

}  // namespace

void add_gantt_command(CLI::App& trace) {
    CLI::App* command = trace.add_subcommand(
        "gantt", "Draw a substep's schedule: tasks by device, planned above measured");
    const auto options = std::make_shared<GanttOptions>();
    command->add_option("TRACE", options->trace, "trace.h5 of a run")->required();
    command->add_option("--frame", options->frame, "its number; default: the last complete one")
        ->type_name("N")
        ->check(whole_number(0));
    command->add_option("--substep", options->substep, "in the frame")
        ->type_name("K")
        ->check(whole_number(0))
        ->capture_default_str();
    command
        ->add_option("--iterations", options->iterations,
                     "only these of the substep, the first and the last, as in 2:3; default: all")
        ->type_name("A:B");
    command
        ->add_option("--out", options->out,
                     "picture, .svg or .png; default: TRACE's name and folder, "
                     "-frameN-substepK.svg, or -frameN-substepK-iterationsA-B.svg")
        ->check(path_name())
        ->type_name("FILE");
    command->footer(
        "Arrows: a device needs what another one made, in the colour of the device that needs it;\n"
        "dashed: copies between memories. In SVG, the mouse over a task shows what it is.\n"
        "Prints the picture's name.\n\n"
        "Examples:\n  weft trace gantt out/tablecloth/trace.h5 --frame 10 --out schedule.png\n"
        "  weft trace gantt out/tablecloth/trace.h5 --iterations 2:3    (as the paper draws them)");
    command->callback([options] { draw_gantt(*options); });
}

}  // namespace weft
