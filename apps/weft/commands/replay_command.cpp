#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "apps/weft/command_line/common_options.h"
#include "apps/weft/command_line/validators.h"
#include "apps/weft/commands/commands.h"
#include "apps/weft/output/progress.h"
#include "apps/weft/trace/recorded_scene.h"
#include "runtime/error.h"
#include "runtime/io/json_text.h"
#include "runtime/trace/trace_reader.h"
#include "simulation/replay.h"

namespace weft {

namespace {

struct ReplayOptions {
    RunOptions run;  ///< quiet, json, and memory if given
    std::string trace;
    std::optional<std::string> device;  ///< none: the recorded ones
    std::optional<std::string> scene;
    std::optional<std::uint32_t> frames;
};

struct Outcome {
    std::size_t frames = 0;                    ///< replayed
    std::size_t compared = 0;                  ///< of them, with a recorded hash
    std::optional<std::uint32_t> first_wrong;  ///< the first frame that ended in another state
    std::string recorded, replayed;            ///< hashes after the last compared frame
    bool equal() const { return !first_wrong && recorded == replayed; }
};

std::string devices_text(const std::vector<DeviceDescription>& devices) {
    std::string text;
    for (const DeviceDescription& d : devices) {
        text += fmt::format("{}{} ({}, {} unit{})", text.empty() ? "" : " + ", d.name, d.kind,
                            d.units, d.units == 1 ? "" : "s");
    }
    return text;
}

/// Replays a trace on its own devices or on others.
class Player {
public:
    explicit Player(const ReplayOptions& options)
        : options_(options), trace_(options.trace), run_(trace_.run()) {
        if (trace_.frames().empty()) fail("the trace has no complete frame: nothing to replay");
        if (!trace_.frame(0).graph) {
            fail(
                "the trace holds no divisions and dependencies: it was written by an older weft; "
                "run the scene again");
        }
        open();
    }

    /// To the end, or to the first frame that ends in another state.
    Outcome play() {
        std::size_t count = trace_.frames().size();
        if (options_.frames) count = std::min<std::size_t>(count, *options_.frames);
        Progress progress("frame", static_cast<int>(count), options_.run.quiet);
        Outcome result;
        for (std::size_t i = 0; i < count && !result.first_wrong; ++i) {
            const FrameRecord frame = trace_.frame(i);
            advance(frame);
            ++result.frames;
            if (!frame.state_hash.empty()) {
                compare(result, frame.frame, frame.state_hash);
                ++result.compared;
            }
            progress.show(static_cast<int>(i) + 1);
        }
        const bool whole = result.frames == trace_.frames().size() && trace_.finished();
        if (whole) compare(result, trace_.frames().back().frame, trace_.state_hash());
        if (result.recorded.empty()) fail("the trace holds no state hash to compare with");
        return result;
    }

    const TraceReader& trace() const { return trace_; }
    RunDescription devices() const { return replay_->simulation().describe(); }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw UserError(options_.trace + ": " + what);
    }

    SimulationOptions settings() const {
        RunOptions options;
        options.device = options_.device.value_or(recorded_setting(run_, "devices"));
        options.math = recorded_setting(run_, "math");
        options.memory = options_.run.memory;
        const std::string memory = recorded_setting(run_, "memory");
        if (!options_.device && options.memory == "auto" && !memory.empty()) {
            options.memory = memory;
        }
        return options.simulation();
    }

    void open() {
        const Scene scene = recorded_scene(run_, options_.scene);
        Warnings warnings;
        try {
            replay_.emplace(scene, settings(), run_, warnings);
        } catch (const UserError& error) {
            if (options_.device) throw;
            fail(fmt::format("was recorded on {}: {}; --device LIST replays on other devices",
                             devices_text(run_.devices), error.what()));
        }
        if (!options_.device) check_devices();
        say("replaying " + std::string(trace_.finished() ? "" : "what there is of ") +
            run_.scene_name + " on " + devices_text(devices().devices));
    }

    /// A name such as "hybrid" may stand for something else here.
    void check_devices() const {
        const std::vector<DeviceDescription> here = devices().devices;
        bool same = here.size() == run_.devices.size();
        for (std::size_t d = 0; same && d < here.size(); ++d) {
            same = here[d].kind == run_.devices[d].kind;
        }
        if (!same) {
            fail(fmt::format(
                "was recorded on {}, but '{}' is {} here; --device LIST replays on "
                "other devices",
                devices_text(run_.devices), recorded_setting(run_, "devices"), devices_text(here)));
        }
        if (devices_text(here) != devices_text(run_.devices)) {
            say("recorded on " + devices_text(run_.devices));
        }
    }

    void say(const std::string& text) const {
        if (!options_.run.quiet) std::cerr << "weft: " << text << std::endl;
    }

    void advance(const FrameRecord& frame) {
        try {
            replay_->advance(frame);
        } catch (const UserError& error) {
            fail(error.what());
        }
    }

    void compare(Outcome& result, std::uint32_t frame, const std::string& recorded) const {
        result.recorded = recorded;
        result.replayed = replay_->simulation().hash();
        if (result.recorded != result.replayed && !result.first_wrong) result.first_wrong = frame;
    }

    const ReplayOptions& options_;
    TraceReader trace_;
    const RunDescription& run_;
    std::optional<Replay> replay_;
};

void print_json(const Player& player, const Outcome& result) {
    nlohmann::ordered_json json{{"scene", player.trace().run().scene_name},
                                {"finished", player.trace().finished()},
                                {"frames", result.frames},
                                {"compared", result.compared},
                                {"devices", nlohmann::ordered_json::array()},
                                {"recorded_hash", result.recorded},
                                {"state_hash", result.replayed},
                                {"equal", result.equal()},
                                {"first_wrong_frame", nullptr}};
    for (const DeviceDescription& d : player.devices().devices) {
        json["devices"].push_back({{"name", d.name}, {"kind", d.kind}, {"units", d.units}});
    }
    if (result.first_wrong) json["first_wrong_frame"] = *result.first_wrong;
    std::cout << json_text(json) << std::endl;
}

void print_text(const Player& player, const Outcome& result) {
    const TraceReader& trace = player.trace();
    const bool whole = trace.finished() && result.frames == trace.frames().size();
    std::cout << fmt::format("{:<16} {} of {}{}\n", "frames", result.frames, trace.frames().size(),
                             trace.finished() ? "" : "; the run did not finish")
              << fmt::format("{:<16} {}\n", "devices", devices_text(player.devices().devices))
              << fmt::format("{:<16} {}\n", "recorded hash", result.recorded)
              << fmt::format("{:<16} {}\n", "state hash", result.replayed)
              << fmt::format("{:<16} {}\n", "equal",
                             !result.equal() ? "no"
                             : whole         ? "yes, after every frame and at the end"
                                             : "yes, after every frame that was replayed")
              << std::flush;
}

void replay_trace(const ReplayOptions& options) {
    Player player(options);
    const Outcome result = player.play();
    if (options.run.json)
        print_json(player, result);
    else
        print_text(player, result);
    if (result.equal()) return;
    const bool fast = recorded_setting(player.trace().run(), "math") != "strict";
    throw RunError(
        fmt::format("{}: the replay differs from the run, first after frame {}{}", options.trace,
                    *result.first_wrong,
                    fast ? "; with --math fast only the same devices give the same bits" : ""));
}

}  // namespace

void add_replay_command(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("replay", "Run again by the recorded plans and compare the states");
    const auto options = std::make_shared<ReplayOptions>();
    command->add_option("TRACE", options->trace, "trace.h5 of a run; also of one that was killed")
        ->required()
        ->type_name("FILE");
    command
        ->add_option("--device", options->device,
                     "other devices than the recorded ones, as in weft run; the tasks of device i "
                     "go to device i modulo their number")
        ->type_name("LIST");
    add_memory_option(*command, options->run);
    command
        ->add_option("--scene", options->scene,
                     "where the scene file is now, if it was moved: meshes are relative to it")
        ->type_name("FILE");
    command->add_option("--frames", options->frames, "only so many")
        ->type_name("N")
        ->check(whole_number(1));
    add_talk_options(*command, options->run);
    command->footer(
        "The scene, what the command line changed, and each frame's plan come from the trace;\n"
        "mesh files must be there unchanged. Nothing is written.\n\n"
        "Exit codes: 0 the states are equal, bit by bit; 1 they are not; 2 the request was wrong,\n"
        "or the recorded devices are not here.\n\n"
        "Examples:\n"
        "  weft replay out/tablecloth/trace.h5\n"
        "  weft replay out/tablecloth/trace.h5 --device cpu/1 --frames 10");
    command->callback([options] { replay_trace(*options); });
}

}  // namespace weft
