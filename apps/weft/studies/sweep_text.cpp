#include "apps/weft/studies/sweep_text.h"

#include <fmt/format.h>

#include <iostream>

#include "apps/weft/batch/make_sweep.h"
#include "apps/weft/output/output_file.h"
#include "runtime/io/json_text.h"

namespace weft {

using batch::Value;

std::string sweep_head(const SweepHead& head, const Value& run,
                       const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    Value table{{"name", head.name}};
    if (!head.scene.empty()) {
        const fs::path scene = fs::absolute(head.scene).lexically_normal();
        const fs::path from = fs::absolute(folder).lexically_normal();
        table["scene"] = scene.lexically_relative(from).string();
    }
    table["command"] = head.command;
    return fmt::format("sweep = {}\nrun = {}\n", batch::to_toml(table), batch::to_toml(run));
}

void add_sweep_options(Value& run, const RunOptions& options) {
    run["math"] = options.math;
    if (options.memory != "auto") run["memory"] = options.memory;
    if (options.async) run["async"] = *options.async;
    if (options.on_crossing != "stop") run["on_crossing"] = options.on_crossing;
}

std::string sweep_axis(const std::string& key, const std::vector<std::string>& values) {
    return fmt::format("\n[[axis]]\nkey = {}\nvalues = {}\n", Value(key).dump(),
                       batch::to_toml(Value(values)));
}

/// The value of --set is TOML already, or a bare word.
std::string sweep_value(const std::string& assignment) {
    const std::size_t equals = assignment.find('=');
    const Value value =
        batch::to_json(parse_toml_value(assignment.substr(equals + 1), "--set " + assignment));
    return fmt::format("\n[[axis]]\nkey = {}\nvalues = [{}]\n",
                       Value(assignment.substr(0, equals)).dump(), batch::to_toml(value));
}

void make_study_sweep(const std::string& text, const std::filesystem::path& folder,
                      const RunOptions& options) {
    const std::string path = (folder / "sweep.toml").string();
    const batch::Made made = batch::make_sweep(batch::parse_sweep(text, path), folder);
    write_output(path, text);
    if (options.json)
        std::cout << json_text(to_json(made)) << std::endl;
    else
        std::cout << to_text(made) << (options.quiet ? "" : batch::next_steps(path)) << std::flush;
}

}  // namespace weft
