#include "apps/weft/command_line/cli_support.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "simulation/scene/near_miss.h"

namespace weft {
namespace {

/// The subcommand that the user has chosen, or weft itself.
const CLI::App& chosen_command(const CLI::App& app) {
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    return chosen.empty() ? app : chosen_command(*chosen.front());
}

std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return names;
}

std::vector<std::string> command_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
        names.push_back(command->get_name());
    }
    return names;
}

std::string command_path(const CLI::App& app, const CLI::App& command) {
    if (&app == &command) return app.get_name();
    return command_path(app, *command.get_parent()) + " " + command.get_name();
}

/// For a word that nothing expects: what it may have been meant to be.
std::string describe_stray_word(const CLI::App& app, const CLI::App& command,
                                const std::string& word) {
    const std::string help = fmt::format("see '{} --help'", command_path(app, command));
    if (word.starts_with("-")) {
        const std::string name = word.substr(0, word.find('='));
        const std::string near = near_miss(name, option_names(command));
        return fmt::format("unknown option '{}'; {}", name, near.empty() ? help : near);
    }
    if (&app == &command) {
        return fmt::format("unknown command '{}'; {}", word,
                           near_miss_or_list(word, command_names(app)));
    }
    return fmt::format("unexpected argument '{}'; {}", word, help);
}

std::string one_line(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

CLI::Validator number_where(bool (*holds)(double), const std::string& expected) {
    const auto check = [=](const std::string& text) -> std::string {
        double value = 0.0;
        const bool is_number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
        if (is_number && holds(value)) return "";
        return fmt::format("'{}': expected {}", text, expected);
    };
    return CLI::Validator(check, "");
}

}  // namespace

void add_scene_options(CLI::App& command, RunOptions& options) {
    command.add_option("SCENE", options.scene, "scene file (.toml)")->required()->type_name("FILE");
    const std::string group = "Scene";
    command.add_option("--solver", options.solver, "solver; overrides the scene")
        ->type_name("NAME")
        ->group(group);
    command.add_option("--frames", options.frames, "frames; overrides the scene")
        ->type_name("N")
        ->group(group);
    command.add_option("--substeps", options.substeps, "steps per frame; overrides the scene")
        ->type_name("N")
        ->group(group);
    command
        .add_option("--iterations", options.iterations,
                    "iterations per substep; overrides the scene")
        ->type_name("N")
        ->group(group);
    command
        .add_option("--set", options.set,
                    "override any scene value, as in --set scene.size=1000000 or "
                    "--set cloth[0].density=0.3; may be repeated")
        ->type_name("TABLE.KEY=VALUE")
        ->allow_extra_args(false)
        ->group(group);
}

void add_memory_option(CLI::App& command, RunOptions& options) {
    command
        .add_option("--memory", options.memory,
                    "how OpenCL devices reach memory: auto (as they say), host, mapped or discrete")
        ->type_name("KIND")
        ->check(one_of({"auto", "host", "mapped", "discrete"}))
        ->capture_default_str()
        ->group("Devices");
}

void add_device_options(CLI::App& command, RunOptions& options) {
    const std::string group = "Devices";
    command
        .add_option("--device", options.device,
                    "cpu, gpu, opencl, opencl:NAME, hybrid, or parts joined by '+', as in "
                    "cpu/1+opencl:0/1: one core, and one compute unit of OpenCL device 0; '|' "
                    "between lists of which the faster one works")
        ->type_name("LIST")
        ->capture_default_str()
        ->group(group);
    command
        .add_option("--plan", options.plan,
                    "auto, exact (strips and seams), placed (each task where it is done best), "
                    "async (no device waits for another; other results), single")
        ->type_name("KIND")
        ->check(one_of({"auto", "exact", "placed", "async", "single"}))
        ->capture_default_str()
        ->group(group);
    command
        .add_option(
            "--async", options.async,
            "how --plan async exchanges: window=N (iterations open at a time, 2), wait=W "
            "(until another device is told, in iterations), merge=auto|sum|mean|position, "
            "dropping=on|off, settle=N (last iterations in step), "
            "order=both|free|within|across (what may overlap); of xpbd also tasks=kinds "
            "(devices share kinds of tasks, not strips), rank=on|off. With --plan auto: async "
            "may be chosen if it is faster; \"\" is all defaults")
        ->type_name("KEY=VALUE,..")
        ->group(group);
    command
        .add_option("--math", options.math,
                    "strict (the same bits on every device and plan) or fast")
        ->type_name("KIND")
        ->check(one_of({"strict", "fast"}))
        ->capture_default_str()
        ->group(group);
    add_memory_option(command, options);
    command
        .add_option("--strips", options.strips,
                    "divide the strips so among the devices, as in 12,20, instead of planning it; "
                    "weft inspect says how many there are")
        ->type_name("N,N")
        ->delimiter(',')
        ->check(zero_or_more())
        ->group(group);
}

void add_output_options(CLI::App& command, RunOptions& options) {
    const std::string group = "Output";
    command.add_option("--out", options.out, "output folder; default: out/<scene name>")
        ->check(path_name())
        ->type_name("DIR")
        ->group(group);
    command.add_flag("--no-geometry", options.no_geometry, "write no geometry")->group(group);
    command.add_flag("--no-trace", options.no_trace, "write no trace")->group(group);
    auto* force = command.add_flag("--force", options.force, "overwrite a finished run");
    auto* resume =
        command.add_flag("--resume", options.resume,
                         "continue a run that was stopped or killed, where there is one");
    command
        .add_option("--checkpoint", options.checkpoint,
                    "seconds of work that a kill may cost; default: 10")
        ->type_name("SECONDS")
        ->check(zero_or_more())
        ->group(group);
    force->group(group)->excludes(resume);
    resume->group(group);
}

void add_trouble_option(CLI::App& command, RunOptions& options) {
    command
        .add_option("--on-trouble", options.on_trouble,
                    "what to do about a frame that ends with energy from nowhere, or beyond the "
                    "scene's [guard]: stop; halve (do it again from its start with twice the "
                    "substeps, up to 16 times as many, and go on with these); report (say so, and "
                    "go on)")
        ->type_name("KIND")
        ->check(one_of({"stop", "halve", "report"}))
        ->capture_default_str()
        ->group("Scene");
}

void add_crossing_option(CLI::App& command, RunOptions& options) {
    command
        .add_option("--on-crossing", options.on_crossing,
                    "what to do about bodies that cross at the start, in a scene with [contact]: "
                    "stop (with the pairs), or warn, and go on")
        ->type_name("KIND")
        ->check(one_of({"stop", "warn"}))
        ->capture_default_str()
        ->group("Scene");
}

void add_talk_options(CLI::App& command, RunOptions& options) {
    command.add_flag("--quiet", options.quiet, "say nothing but results and errors");
    command.add_flag("--json", options.json, "print the results as one JSON document");
}

void add_run_options(CLI::App& command, RunOptions& options) {
    add_scene_options(command, options);
    add_device_options(command, options);
    add_output_options(command, options);
    add_talk_options(command, options);
    add_trouble_option(command, options);
    add_crossing_option(command, options);
    command
        .add_flag_callback(
            "--print-schema",
            [] {
                std::cout << scene_json_schema() << '\n';
                throw CLI::Success();
            },
            "print the JSON Schema of scene files, and stop")
        ->trigger_on_parse();
}

CLI::Validator one_of(std::vector<std::string> choices) {
    const auto check = [choices = std::move(choices)](const std::string& value) -> std::string {
        if (std::find(choices.begin(), choices.end(), value) != choices.end()) return "";
        return fmt::format("'{}' is unknown; {}", value, near_miss_or_list(value, choices));
    };
    return CLI::Validator(check, "");
}

CLI::Validator above_zero() {
    return number_where([](double value) { return value > 0.0; }, "a number above 0");
}

CLI::Validator zero_or_more() {
    return number_where([](double value) { return value >= 0.0; }, "a number, 0 or more");
}

CLI::Validator path_name() {
    const auto check = [](const std::string& value) -> std::string {
        if (!value.empty() && !value.starts_with("--")) return "";
        return fmt::format("'{}': expected the name of a file or folder", value);
    };
    return CLI::Validator(check, "");
}

std::string describe_parse_error(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App& command = chosen_command(app);
    const std::vector<std::string> stray = command.remaining();
    if (!stray.empty()) return describe_stray_word(app, command, stray.front());
    if (&app == &command) {
        return fmt::format("a command is missing; known: {}", fmt::join(command_names(app), ", "));
    }
    return fmt::format("{}; see '{} --help'", one_line(error.what()), command_path(app, command));
}

}  // namespace weft
