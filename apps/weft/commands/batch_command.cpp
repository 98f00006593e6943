#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include "apps/weft/batch/collect.h"
#include "apps/weft/batch/collect_study.h"
#include "apps/weft/batch/drive.h"
#include "apps/weft/batch/engine_script.h"
#include "apps/weft/batch/index_list.h"
#include "apps/weft/batch/listing.h"
#include "apps/weft/batch/make_sweep.h"
#include "apps/weft/batch/watch.h"
#include "apps/weft/command_line/validators.h"
#include "apps/weft/commands/commands.h"
#include "apps/weft/program.h"
#include "runtime/error.h"
#include "runtime/io/json_text.h"

namespace weft {

namespace {

namespace fs = std::filesystem;

struct BatchOptions {
    std::string sweep;  ///< file or folder
    std::optional<std::string> out;
    std::optional<std::string> index;
    std::optional<std::string> state;
    std::optional<std::string> engine;
    bool list = false;
    bool commands = false;
    bool ranges = false;
    bool collect = false;
    bool watch = false;
    bool again = false;
    bool dropped = false;
    bool quiet = false;
    bool json = false;
};

/// The sweep's folder: given itself, or by the name in the sweep file, of which the rest does not
/// matter any more.
fs::path folder_of(const BatchOptions& options) {
    if (fs::is_directory(options.sweep)) return options.sweep;
    return batch::sweep_folder(batch::sweep_name(options.sweep), options.out);
}

batch::Manifest manifest_of(const BatchOptions& options, const fs::path& folder) {
    batch::Manifest manifest = batch::read_manifest(folder);
    if (!fs::is_directory(options.sweep)) batch::check_made_by(manifest, folder, options.sweep);
    return manifest;
}

int run_program_with(const std::vector<std::string>& arguments) {
    std::vector<std::string> words{"weft"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return run_program(static_cast<int>(words.size()), pointers.data());
}

void make(const BatchOptions& options) {
    if (fs::is_directory(options.sweep)) {
        throw UserError(options.sweep +
                        ": is a folder; expected a sweep file (.toml), or one of --index, --list, "
                        "--collect, --script");
    }
    const batch::Sweep sweep = batch::read_sweep(options.sweep);
    const fs::path folder = batch::sweep_folder(sweep.name, options.out);
    const batch::Made made = batch::make_sweep(sweep, folder);
    if (options.json)
        std::cout << json_text(to_json(made)) << std::endl;
    else
        std::cout << to_text(made) << (options.quiet ? "" : batch::next_steps(options.sweep))
                  << std::flush;
}

/// 75 if anything goes on, or else the highest code.
int overall(const std::vector<batch::Outcome>& outcomes) {
    int code = 0;
    for (const batch::Outcome& outcome : outcomes) {
        if (outcome.exit_code == batch::kGoesOn) return batch::kGoesOn;
        code = std::max(code, outcome.exit_code);
    }
    return code;
}

nlohmann::ordered_json to_json(const std::vector<batch::Outcome>& outcomes) {
    auto list = nlohmann::ordered_json::array();
    for (const batch::Outcome& outcome : outcomes) {
        list.push_back({{"index", outcome.index}, {"exit_code", outcome.exit_code}});
        if (!outcome.why.empty()) list.back()["why"] = outcome.why;
    }
    return list;
}

/// One message for all that did not finish.
void conclude(const std::vector<batch::Outcome>& outcomes, const std::string& name) {
    const int code = overall(outcomes);
    if (code == 0) return;
    const auto first =
        std::ranges::find(outcomes, code, [](const batch::Outcome& o) { return o.exit_code; });
    const auto unfinished =
        std::ranges::count_if(outcomes, [](const batch::Outcome& o) { return o.exit_code != 0; });
    std::string text = fmt::format("{}: run {}: {}", name, first->index, first->why);
    if (unfinished > 1) text += fmt::format(" (and {} more did not finish)", unfinished - 1);
    if (code == batch::kGoesOn) throw EndedEarly(code, text + "; the same command goes on");
    if (code == 1) throw RunError(text);
    throw UserError(text);
}

void run_indices(const BatchOptions& options, const fs::path& folder) {
    const batch::Manifest manifest = manifest_of(options, folder);
    const auto indices =
        batch::parse_indices(*options.index, manifest.runs.size(), manifest.current());
    const auto outcomes = batch::drive(
        folder, manifest, indices,
        {options.again, options.quiet || indices.size() == 1, WEFT_VERSION}, run_program_with);
    if (options.json) std::cout << json_text(to_json(outcomes)) << std::endl;
    conclude(outcomes, manifest.name);
}

void list(const BatchOptions& options, const fs::path& folder) {
    const batch::Manifest manifest = manifest_of(options, folder);
    const auto all = batch::list_runs(folder, manifest, options.dropped);
    auto chosen = all;
    if (options.state) {
        chosen = batch::with_states(all, batch::parse_states(*options.state, "--state"));
    }
    if (options.json)
        std::cout << json_text(to_json(chosen)) << std::endl;
    else if (options.ranges)
        std::cout << batch::to_ranges(batch::indices_of(chosen)) << std::endl;
    else if (options.commands)
        std::cout << batch::to_commands(chosen, folder) << std::flush;
    else
        std::cout << batch::to_table(chosen) << batch::counts_text(batch::count_states(all))
                  << std::endl;
}

void collect(const BatchOptions& options, const fs::path& folder) {
    const batch::Manifest manifest = manifest_of(options, folder);
    batch::Collected collected = batch::collect(folder, manifest, options.dropped);
    batch::collect_study(folder, manifest, collected);
    for (const std::string& note : collected.differences) {
        std::cerr << "weft: warning: " << note << '\n';
    }
    if (options.json)
        std::cout << json_text(to_json(collected)) << std::endl;
    else
        std::cout << to_text(collected) << std::flush;
}

void print_script(const BatchOptions& options, const fs::path& folder) {
    const batch::Manifest manifest = manifest_of(options, folder);
    std::cout << batch::script_for(*options.engine, manifest, folder) << std::flush;
}

void check_alone(const BatchOptions& options) {
    const int actions = int(options.index.has_value()) + int(options.list) + int(options.collect) +
                        int(options.watch) + int(options.engine.has_value());
    if (actions > 1) {
        throw UserError("--index, --list, --watch, --collect and --script: one of them at a time");
    }
}

void run_batch(const BatchOptions& options) {
    check_alone(options);
    if (options.index) return run_indices(options, folder_of(options));
    if (options.list) return list(options, folder_of(options));
    if (options.watch) {
        const fs::path folder = folder_of(options);
        return batch::watch(folder, manifest_of(options, folder));
    }
    if (options.collect) return collect(options, folder_of(options));
    if (options.engine) return print_script(options, folder_of(options));
    make(options);
}

void add_list_options(CLI::App& command, BatchOptions& options) {
    const std::string group = "Looking";
    CLI::Option* list = command.add_flag("--list", options.list, "what has become of each run");
    list->group(group);
    command
        .add_option("--state", options.state,
                    "only these: waiting, running, lost, stopped, failed, finished")
        ->type_name("S,S")
        ->needs(list)
        ->group(group);
    auto* commands =
        command.add_flag("--commands", options.commands, "print a command per line instead");
    auto* ranges = command.add_flag("--ranges", options.ranges,
                                    "print numbers instead, as job arrays take them: 1,3-7");
    commands->needs(list)->excludes(ranges)->group(group);
    ranges->needs(list)->group(group);
    command
        .add_flag("--dropped", options.dropped,
                  "list and collect runs, too, that the sweep file has no more")
        ->group(group);
    command
        .add_flag("--watch", options.watch,
                  "tell how far the sweep is, until all runs are finished or failed")
        ->group(group);
    command
        .add_flag("--collect", options.collect,
                  "gather the results of all runs: results.csv, results.h5; at any time")
        ->group(group);
}

}  // namespace

void add_batch_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("batch", "Run a sweep: one scene, many values");
    const auto options = std::make_shared<BatchOptions>();
    command->add_option("SWEEP", options->sweep, "sweep file (.toml), or the folder it has made")
        ->required()
        ->type_name("FILE");
    command->add_option("--out", options->out, "folder of the sweep; default: out/<sweep name>")
        ->type_name("DIR");
    command->add_option("--index", options->index, "do these runs, as in 7, 0-47, 3,9 or all")
        ->type_name("N,N-N");
    command->add_flag(
        "--again", options->again,
        "with --index: failed runs start anew, killed ones go on from their checkpoint");
    command
        ->add_option("--script", options->engine,
                     "print a job script for slurm, parallel, hyperqueue or snakemake")
        ->type_name("ENGINE")
        ->check(one_of(batch::engines()));
    add_list_options(*command, *options);
    command->add_flag("--quiet", options->quiet, "say nothing but results and errors");
    command->add_flag("--json", options->json, "print the results as one JSON document");
    command->footer(
        "Checks every run of the sweep file, and writes its manifest; --index does runs by it, "
        "each\n"
        "in a process of its own, and goes on where one was stopped (docs/batch.md).\n\n"
        "Exit codes of --index: 0 finished; 1 failed; 2 the request was wrong; 75 stopped in good\n"
        "order, or another process is at it: the same command goes on.\n\n"
        "Examples:\n"
        "  weft batch sweep.toml\n"
        "  weft batch sweep.toml --index 0-47\n"
        "  weft batch sweep.toml --list --state failed --ranges\n"
        "  weft batch sweep.toml --collect");
    command->callback([options] { run_batch(*options); });
}

}  // namespace weft
