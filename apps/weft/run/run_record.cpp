#include "apps/weft/run/run_record.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "apps/weft/command_line/typed_line.h"
#include "runtime/trace/host_info.h"
#include "simulation/description/versions.h"

namespace weft {

namespace {

TextPairs versions() {
    TextPairs pairs{{"weft", WEFT_VERSION}};
    for (const TextPairs& more : {runtime_versions(), simulation_versions()})
        pairs.insert(pairs.end(), more.begin(), more.end());
    pairs.emplace_back("cli11", CLI11_VERSION);
    return pairs;
}

}  // namespace

/// The devices that cannot keep strict arithmetic's promise.
std::vector<std::string> loose_devices(const Simulation& simulation) {
    std::vector<std::string> names;
    for (const auto& device : simulation.devices()) {
        if (!device->info().strict) names.push_back(device->info().name);
    }
    return names;
}

RunDescription describe_run(const Simulation& simulation, const RunOptions& options) {
    RunDescription run = simulation.describe();
    run.command = command_line();
    run.host = host_info();
    run.versions = versions();
    run.settings.emplace_back("devices", options.device);
    run.settings.emplace_back("plan", options.plan);
    run.settings.emplace_back("math", options.math);
    run.settings.emplace_back("on_trouble", options.on_trouble);
    if (simulation.model().scene.contact)
        run.settings.emplace_back("on_crossing", options.on_crossing);
    if (options.memory != "auto") run.settings.emplace_back("memory", options.memory);
    if (!options.strips.empty()) {
        run.settings.emplace_back("division", fmt::format("{}", fmt::join(options.strips, ",")));
    }
    const std::vector<std::string> loose = loose_devices(simulation);
    if (options.math == "strict" && !loose.empty()) {
        run.settings.emplace_back("not_strict", fmt::format("{}", fmt::join(loose, ", ")));
    }
    return run;
}

}  // namespace weft
