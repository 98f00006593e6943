#include "apps/weft/batch/make_sweep.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/weft/batch/listing.h"
#include "apps/weft/batch/run_folder.h"
#include "apps/weft/command_line/common_options.h"
#include "apps/weft/command_line/parse_error.h"
#include "apps/weft/commands/study_options.h"
#include "apps/weft/studies/error_study.h"
#include "runtime/device_list.h"
#include "runtime/error.h"

namespace weft::batch {

namespace {

namespace fs = std::filesystem;

/// The program's commands as it reads them itself; but nothing is done.
struct Reader {
    CLI::App app{"", "weft"};
    RunOptions run;
    ErrorOptions study;
    stability::StudyOptions suite;

    Reader() {
        add_run_options(*app.add_subcommand("run"), run);
        add_error_options(*app.add_subcommand("error"), study);
        add_stability_options(*app.add_subcommand("stability"), suite);
    }
};

void check_options(const std::string& command, const std::vector<std::string>& options) {
    Reader reader;
    CLI::App& app = reader.app;
    std::vector<std::string> words{command, "scene.toml"};
    words.insert(words.end(), options.begin(), options.end());
    std::ranges::reverse(words);  // as CLI11 wants them
    try {
        app.parse(words);
    } catch (const CLI::ParseError& error) {
        throw UserError(describe_parse_error(app, error));
    }
    if (command == "run") reader.run.check_async();
    if (command == "stability") static_cast<void>(stability::chosen_cases(reader.suite));
    for (const char* name : {"--device", "--devices"}) {
        const CLI::Option* option = app.get_subcommand(command)->get_option_no_throw(name);
        if (option == nullptr) continue;
        for (const std::string& list : option->results()) check_device_list(list);
    }
}

/// Those that are looked up and not run are no options of a run.
bool is_of_runs(const std::string& name) { return name != "help" && name != "print-schema"; }

/// --no-geometry is the key no_geometry, and the key geometry, too.
void add_keys(std::map<std::string, bool>& flags, std::string name, bool is_flag) {
    std::ranges::replace(name, '-', '_');
    flags.emplace(name, is_flag);
    const std::string no = "no_";
    if (name.starts_with(no)) flags.emplace(name.substr(no.size()), is_flag);
}

CommandLine command_line_of(const std::string& command) {
    const Reader reader;
    CommandLine line{{}, [command](const auto& words) { check_options(command, words); }};
    for (const CLI::Option* option : reader.app.get_subcommand(command)->get_options()) {
        const bool is_flag = option->get_expected_min() == 0;
        for (const std::string& name : option->get_lnames()) {
            if (is_of_runs(name)) add_keys(line.flags, name, is_flag);
        }
    }
    return line;
}

std::size_t count_dropped(const std::vector<Run>& runs) {
    return static_cast<std::size_t>(std::ranges::count_if(runs, &Run::dropped));
}

}  // namespace

fs::path sweep_folder(const std::string& name, const std::optional<std::string>& out) {
    return out ? fs::path(*out) : fs::path("out") / name;
}

Made make_sweep(const Sweep& sweep, const fs::path& folder) {
    std::vector<Run> now = runs_of(sweep, folder, command_line_of(sweep.command));
    Made made{sweep.name, folder, now.size()};
    FolderLock lock;  // two of these at a time might give one number twice
    if (!lock.take(folder)) {
        throw RunError(folder.string() + ": another process is making this sweep; try again");
    }
    Manifest before;
    if (fs::exists(manifest_path(folder))) {
        before = read_manifest(folder);
        check_made_by(before, folder, sweep.path);
    }
    const std::string file =
        fs::absolute(sweep.path).lexically_normal().lexically_relative(fs::absolute(folder));
    const Manifest manifest{sweep.name,
                            sweep.command,
                            WEFT_VERSION,
                            file,
                            sweep.text,
                            sweep.time_limit,
                            merged(before.runs, std::move(now))};
    made.added = manifest.runs.size() - before.runs.size();
    made.dropped = count_dropped(manifest.runs);
    write_manifest(folder, manifest);
    return made;
}

std::string to_text(const Made& made) {
    std::string text =
        fmt::format("{}: {} runs in {}", made.name, made.current, made.folder.string());
    if (made.added != made.current) text += fmt::format(", {} of them new", made.added);
    text += '\n';
    if (made.dropped > 0) {
        text += fmt::format(
            "{} runs stand in the manifest that the sweep file has no more (--dropped lists "
            "them)\n",
            made.dropped);
    }
    return text;
}

std::string next_steps(const std::string& sweep_file) {
    return fmt::format(
        "next:\n"
        "  weft batch {0} --index all          all of them here, one after the other\n"
        "  weft batch {0} --script slurm       a job script; also parallel, "
        "hyperqueue, snakemake\n"
        "  weft batch {0} --list               what has become of them\n"
        "  weft batch {0} --collect            results.csv, results.h5\n",
        shell_word(sweep_file));
}

nlohmann::ordered_json to_json(const Made& made) {
    return {{"name", made.name},
            {"folder", made.folder.string()},
            {"runs", made.current},
            {"new", made.added},
            {"dropped", made.dropped}};
}

}  // namespace weft::batch
