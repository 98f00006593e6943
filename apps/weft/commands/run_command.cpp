#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/weft/command_line/common_options.h"
#include "apps/weft/commands/commands.h"
#include "apps/weft/output/warnings.h"
#include "apps/weft/run/scene_run.h"
#include "runtime/error.h"
#include "runtime/io/json_text.h"

namespace weft {

namespace {

void run_scene(const RunOptions& options, bool keeps_checkpoint) {
    const InterruptNotice notice;
    SceneRun run(options, keeps_checkpoint);
    if (run.done()) {
        if (!options.quiet) {
            std::cerr << fmt::format("weft: {}: the run there is done, there is nothing to do\n",
                                     run.folder().path().string());
        }
        if (options.json) std::cout << *run.done() << std::flush;
        return;
    }
    run.advance_all(notice);
    const RunSummary summary = run.finish();
    if (options.json)
        std::cout << json_text(to_json(summary)) << std::endl;
    else
        std::cout << to_text(summary) << std::flush;
    if (summary.finished) return;
    throw Interrupted(notice.signal(),
                      fmt::format("stopped by {} after {} of {} frames; they are in {}",
                                  signal_name(notice.signal()), run.frames_done(),
                                  run.frame_count(), run.folder().path().string()));
}

}  // namespace

void add_run_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("run", "Simulate a scene");
    const auto options = std::make_shared<RunOptions>();
    add_run_options(*command, *options);
    const auto keeps_checkpoint = std::make_shared<bool>(false);
    command
        ->add_flag("--keep-checkpoint", *keeps_checkpoint,
                   "leave the end's state as a checkpoint, for weft error --start")
        ->group("Output");
    command->footer(
        "Writes trace.h5, frames.vtkhdf, frames.xdmf and summary.json into the output folder\n"
        "(docs/trace-format.md), and prints the summary.\n\n"
        "Exit codes: 0 done; 1 the run failed, everything before is on disk; 2 the request was\n"
        "wrong; 128 + signal: stopped by SIGINT, SIGTERM, SIGHUP or SIGUSR1 after a whole frame\n"
        "(only a second SIGINT stops at once). A run that was stopped or killed goes on with\n"
        "--resume, and ends as if nothing had happened; one that is done is left as it is.\n\n"
        "Examples:\n"
        "  weft run scenes/tablecloth.toml\n"
        "  weft run scenes/flag.toml --device cpu/1+opencl:0/1 --set scene.size=40000 --out "
        "out/big\n"
        "  weft run scenes/skirt.toml --frames 5 --no-geometry --json --quiet");
    command->callback([options, keeps_checkpoint] { run_scene(*options, *keeps_checkpoint); });
}

}  // namespace weft
