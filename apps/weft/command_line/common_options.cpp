#include "apps/weft/command_line/common_options.h"

#include <iostream>

#include "apps/weft/command_line/validators.h"

namespace weft {

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
        ->check(whole_number(0))
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
    auto* force = command.add_flag("--force", options.force, "overwrite a run that is there");
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
                    "what to do about a frame that has exploded (beyond the scene's [guard], or "
                    "with far more energy than there was) or is not finite: stop; halve (do it "
                    "again from its start with twice the substeps, up to 16 times as many, and go "
                    "on with these); report (say so, and go on, unless it is not finite). Of one "
                    "to be doubted, stop and report warn, and halve does it again")
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

}  // namespace weft
