#include "apps/weft/studies/study_sweep.h"

#include "apps/weft/studies/sweep_text.h"

namespace weft {

namespace {

batch::Value options_for_all(const ErrorOptions& options) {
    batch::Value run = batch::Value::object();
    add_sweep_options(run, options.run);
    if (options.time) run["time"] = *options.time;
    if (!options.trajectory) {
        if (options.frame) run["frame"] = *options.frame;
        if (options.start) run["start"] = std::filesystem::absolute(*options.start).string();
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
    std::string text =
        sweep_head({name, "error", options.run.scene}, options_for_all(options), folder);
    for (const Override& value : options.run.overrides()) text += sweep_value(value.assignment);
    text += sweep_axis("run.solvers", options.solvers);
    text += sweep_axis("run.devices", options.devices);
    return text + sweep_axis("run.plans", options.plans);
}

}  // namespace weft
