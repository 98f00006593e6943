#include "apps/weft/studies/stability/stability_study.h"

#include <algorithm>

#include "apps/weft/studies/sweep_text.h"
#include "runtime/error.h"
#include "runtime/near_miss.h"

namespace weft::stability {

namespace {

bool is_chosen(const Case& what, const StudyOptions& options) {
    const std::string name = full_name(what);
    if (!options.one_case.empty()) return name == options.one_case;
    return (what.in_short || !options.is_short) && name.find(options.only) != std::string::npos;
}

std::vector<std::string> names_of(const std::vector<Case>& cases) {
    std::vector<std::string> names;
    for (const Case& what : cases) names.push_back(full_name(what));
    return names;
}

[[noreturn]] void fail_for_none(const StudyOptions& options) {
    if (options.one_case.empty())
        throw UserError("--only: no case has '" + options.only + "' in its name");
    const std::string near = near_miss(options.one_case, names_of(all_cases()));
    throw UserError("--case: no case '" + options.one_case + "'; " +
                    (near.empty() ? "stability.csv has all names" : near));
}

}  // namespace

std::string full_name(const Case& what) { return what.group + ": " + what.name; }

std::vector<Case> chosen_cases(const StudyOptions& options) {
    std::vector<Case> cases = all_cases();
    std::erase_if(cases, [&](const Case& what) { return !is_chosen(what, options); });
    if (cases.empty()) fail_for_none(options);
    return cases;
}

std::string sweep_text(const StudyOptions& options, const std::string& name,
                       const std::filesystem::path& folder) {
    batch::Value run = batch::Value::object();
    run["device"] = options.run.device;
    run["plan"] = options.run.plan;
    add_sweep_options(run, options.run);
    const bool of_scene = !options.run.scene.empty();
    if (of_scene) run["time"] = options.time;
    std::string text = sweep_head({name, "stability", options.run.scene}, run, folder);
    for (const Override& value : options.run.overrides()) text += sweep_value(value.assignment);
    if (!of_scene) text += sweep_axis("run.case", names_of(chosen_cases(options)));
    return text + sweep_axis("run.solvers", options.solvers);
}

}  // namespace weft::stability
