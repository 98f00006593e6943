#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "apps/weft/command_line/validators.h"
#include "apps/weft/commands/commands.h"
#include "apps/weft/output/output_file.h"
#include "apps/weft/trace/perfetto.h"
#include "apps/weft/trace/recorded_frames.h"
#include "runtime/error.h"

namespace weft {

namespace {

struct PerfettoOptions {
    std::string trace;
    std::optional<std::string> frames;
    std::optional<std::string> out;
};

void export_trace(const PerfettoOptions& options) {
    const TraceReader trace(options.trace);
    const NumberRange range =
        options.frames ? parse_range(*options.frames, "--frames", "frame") : NumberRange{};
    const auto& frames = trace.frames();
    if (options.frames) {  // both ends that were given must be there
        find_frame(trace, options.trace, range.first);
        if (range.last != NumberRange{}.last) find_frame(trace, options.trace, range.last);
    } else {
        find_frame(trace, options.trace, std::nullopt);
    }
    std::filesystem::path path = options.trace;
    path.replace_extension(".perfetto.json");
    if (options.out) path = *options.out;

    PerfettoText text(trace.run());
    WholeFile file = open_output(path);
    file.write(text.head());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (frames[i].frame < range.first || frames[i].frame > range.last) continue;
        try {
            file.write(text.frame(trace.frame(i)));
        } catch (const UserError& error) {
            throw UserError(options.trace + ": " + error.what());
        }
    }
    file.write(text.tail());
    file.finish();
    std::cout << path.string() << '\n';
}

}  // namespace

void add_perfetto_command(CLI::App& trace) {
    CLI::App* command =
        trace.add_subcommand("perfetto", "Write a trace as JSON for Perfetto's viewer");
    const auto options = std::make_shared<PerfettoOptions>();
    command->add_option("TRACE", options->trace, "trace.h5 of a run")->required();
    command->add_option("--frames", options->frames, "the first and the last; default: all")
        ->type_name("A:B");
    command
        ->add_option("--out", options->out,
                     "file; default: beside TRACE, with the ending .perfetto.json")
        ->check(path_name())
        ->type_name("FILE");
    command->footer(
        "Chrome's trace-event format: open the file at https://ui.perfetto.dev or in\n"
        "chrome://tracing. A frame takes about 300 bytes for each task of each substep. Prints "
        "the\n"
        "file's name.\n\n"
        "Example:\n  weft trace perfetto out/tablecloth/trace.h5 --frames 10:19 --out t.json");
    command->callback([options] { export_trace(*options); });
}

}  // namespace weft
