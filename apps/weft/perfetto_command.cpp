#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <charconv>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "apps/weft/commands.h"
#include "apps/weft/output_file.h"
#include "apps/weft/perfetto.h"
#include "apps/weft/trace_support.h"
#include "runtime/error.h"

namespace weft {

namespace {

struct PerfettoOptions {
    std::string trace;
    std::optional<std::string> frames;
    std::optional<std::string> out;
};

struct FrameRange {
    std::uint32_t first = 0;
    std::uint32_t last = std::numeric_limits<std::uint32_t>::max();
};

/// "A:B", both included, either left out, or "A".
FrameRange parse_range(const std::string& text) {
    const auto wrong = [&]() {
        return UserError(
            fmt::format("--frames {}: expected A:B, the first and the last frame, "
                        "as in 10:19",
                        text));
    };
    const auto number = [&](const std::string& part, std::uint32_t fallback) {
        if (part.empty()) return fallback;
        std::uint32_t value = 0;
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (error != std::errc() || end != part.data() + part.size()) throw wrong();
        return value;
    };
    FrameRange range;
    const std::size_t colon = text.find(':');
    if (text.empty() || text == ":") throw wrong();
    range.first = number(text.substr(0, colon), range.first);
    range.last =
        colon == std::string::npos ? range.first : number(text.substr(colon + 1), range.last);
    if (range.first > range.last) throw wrong();
    return range;
}

void export_trace(const PerfettoOptions& options) {
    const TraceReader trace(options.trace);
    const FrameRange range = options.frames ? parse_range(*options.frames) : FrameRange{};
    const auto& frames = trace.frames();
    if (options.frames) {  // both ends that were given must be there
        find_frame(trace, options.trace, range.first);
        if (range.last != FrameRange{}.last) find_frame(trace, options.trace, range.last);
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
