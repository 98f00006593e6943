#include "apps/weft/run/run_options.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "runtime/error.h"
#include "runtime/io/cache_folder.h"

namespace weft {
namespace {

/// --memory; "auto": what the device says of itself.
std::optional<MemoryModel> memory_model(const std::string& name) {
    for (const auto model : {MemoryModel::kHost, MemoryModel::kMapped, MemoryModel::kDiscrete}) {
        if (name == name_of(model)) return model;
    }
    return std::nullopt;
}

/// "async:rank=off+window=3": one of a list of plans, whose commas are the list's.
struct PlanName {
    std::string kind, settings;

    explicit PlanName(const std::string& text) : kind(text.substr(0, text.find(':'))) {
        if (kind.size() == text.size()) return;
        if (kind != "async") {
            throw UserError(fmt::format("--plans {}: only async has settings", text));
        }
        settings = text.substr(kind.size() + 1);
        std::ranges::replace(settings, '+', ',');
    }
};

PlanKind plan_kind(const std::string& name) {
    if (name == "auto") return PlanKind::kAuto;
    if (name == "exact") return PlanKind::kExact;
    if (name == "placed") return PlanKind::kPlaced;
    if (name == "async") return PlanKind::kAsync;
    if (name == "single") return PlanKind::kSingle;
    throw UserError(fmt::format("--plan {}: expected auto, exact, placed, async or single", name));
}

OnTrouble on_trouble_of(const std::string& name) {
    if (name == "halve") return OnTrouble::kHalve;
    return name == "report" ? OnTrouble::kReport : OnTrouble::kStop;
}

/// Of the user, unless a sweep keeps its own: runs side by side measure other times than alone.
std::filesystem::path usual_cost_file() {
    if (const char* own = std::getenv("WEFT_COSTS")) return own;
    const auto folder = cache_folder();
    return folder.empty() ? folder : folder / "costs.json";
}

}  // namespace

std::vector<Override> RunOptions::overrides() const {
    std::vector<Override> list;
    for (const std::string& assignment : set) list.push_back({assignment, "--set " + assignment});
    const auto add = [&](const std::optional<std::string>& value, const char* option,
                         const char* path) {
        if (value)
            list.push_back(
                {fmt::format("{}={}", path, *value), fmt::format("{} {}", option, *value)});
    };
    add(solver, "--solver", "solver.method");
    add(frames, "--frames", "scene.frames");
    add(substeps, "--substeps", "scene.substeps");
    add(iterations, "--iterations", "solver.iterations");
    return list;
}

SimulationOptions RunOptions::simulation() const {
    SimulationOptions options;
    options.devices = device;
    const PlanName name(plan);
    options.plan = plan_kind(name.kind);
    const std::string given = async.value_or("");
    options.async = parse_async_settings(given + (given.empty() ? "" : ",") + name.settings);
    options.may_be_async = async.has_value();
    if (options.may_be_async && options.plan == PlanKind::kAuto &&
        options.async.tasks == AsyncSettings::Tasks::kKinds) {
        throw UserError("--async tasks=kinds: is for --plan async; auto divides strips alone");
    }
    options.device_options.strict_math = math == "strict";
    options.device_options.memory = memory_model(memory);
    if (!strips.empty()) options.division = Division{strips};
    options.cost_file = usual_cost_file();
    options.on_trouble = on_trouble_of(on_trouble);
    options.on_crossing = on_crossing == "warn" ? OnCrossing::kWarn : OnCrossing::kStop;
    return options;
}

std::filesystem::path RunOptions::folder_for(const std::string& scene_name) const {
    if (out) return *out;
    return std::filesystem::path("out") / scene_name;
}

void RunOptions::check_async() const {
    if (!async || plan == "auto" || plan == "async") return;
    throw UserError(fmt::format("--async {}: is for --plan async, or auto, and not for --plan {}",
                                async->empty() ? "\"\"" : *async, plan));
}

}  // namespace weft
