#include "apps/weft/studies/study_sweep.h"

#include <fmt/format.h>

#include "apps/weft/batch/toml_values.h"

namespace weft {

namespace {

using batch::Value;

std::string axis(const std::string& key, const std::vector<std::string>& values) {
    return fmt::format("\n[[axis]]\nkey = {}\nvalues = {}\n", Value(key).dump(),
                       batch::to_toml(Value(values)));
}

/// The value of --set is TOML already, or a bare word.
std::string scene_value(const std::string& assignment) {
    const std::size_t equals = assignment.find('=');
    const Value value =
        batch::to_json(parse_toml_value(assignment.substr(equals + 1), "--set " + assignment));
    return fmt::format("\n[[axis]]\nkey = {}\nvalues = [{}]\n",
                       Value(assignment.substr(0, equals)).dump(), batch::to_toml(value));
}

Value options_for_all(const ErrorOptions& options) {
    Value run = Value::object();
    run["math"] = options.run.math;
    if (options.run.memory != "auto") run["memory"] = options.run.memory;
    if (options.time) run["time"] = *options.time;
    if (!options.trajectory) {
        if (options.frame) run["frame"] = *options.frame;
        run["max_iterations"] = options.max_iterations;
        return run;
    }
    run["trajectory"] = true;
    run["sweep_substeps"] = options.sweep_substeps;
    run["sweep_iterations"] = options.sweep_iterations;
    run["max_work"] = options.max_work;
    if (options.reference_substeps) run["reference_substeps"] = *options.reference_substeps;
    return run;
}

}  // namespace

std::string study_sweep(const ErrorOptions& options, const std::string& name,
                        const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    const fs::path scene = fs::absolute(options.run.scene).lexically_normal();
    const fs::path from = fs::absolute(folder).lexically_normal();
    const Value head{
        {"name", name}, {"scene", scene.lexically_relative(from).string()}, {"command", "error"}};
    std::string text = fmt::format("sweep = {}\nrun = {}\n", batch::to_toml(head),
                                   batch::to_toml(options_for_all(options)));
    for (const Override& value : options.run.overrides()) text += scene_value(value.assignment);
    text += axis("run.solvers", options.solvers);
    text += axis("run.devices", options.devices);
    return text + axis("run.plans", options.plans);
}

}  // namespace weft
