#include "apps/weft/run/run_origin.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "runtime/io/cache_folder.h"
#include "simulation/description/run_description.h"
#include "simulation/solver/async_iterates.h"

namespace weft {
namespace {

/// Asynchronous results depend on the map, which depends on the cuts.
void add_async(const Simulation& simulation, const RunOptions& options, TextPairs& parts) {
    const auto* async = dynamic_cast<const AsyncIterates*>(&simulation.solver());
    if (async == nullptr) return;
    std::string units;
    for (const auto& device : simulation.devices()) {
        units += fmt::format(" {}", device->info().units);
    }
    parts.emplace_back("--async", to_text(async->settings()));
    if (!options.strips.empty()) {
        parts.emplace_back("--strips", fmt::format("{}", fmt::join(options.strips, ",")));
    }
    parts.emplace_back("units of devices", units);
}

}  // namespace

TextPairs request_parts(const RunOptions& options, const Scene& scene) {
    TextPairs parts{{"version of weft", WEFT_VERSION},
                    {"--math", options.math},
                    {"text of the scene file", cache_key(scene.text)}};
    for (const std::string& assignment : scene.overrides) {
        const std::size_t equals = assignment.find('=');
        const std::string key = assignment.substr(0, equals);
        if (key != "scene.frames") parts.emplace_back(key, assignment.substr(equals + 1));
    }
    return parts;
}

/// With the meshes, once it is known that they can be read, and what a checkpoint's positions count
/// from.
TextPairs run_origin(TextPairs request, const RunOptions& options, const TextPairs& meshes,
                     const Simulation& simulation) {
    for (const auto& [body, hash] : meshes) request.emplace_back("mesh of " + body, hash);
    request.emplace_back("place that positions count from", origin_setting(simulation.model()));
    add_async(simulation, options, request);
    return request;
}

std::optional<FinishedRun> read_finished(const std::filesystem::path& summary) {
    std::ifstream stream(summary, std::ios::binary);
    FinishedRun run;
    run.text = std::string(std::istreambuf_iterator<char>(stream), {});
    try {
        const auto json = nlohmann::json::parse(run.text);
        run.made_from = json.at("made_from").get<TextPairs>();
        run.frames = json.at("frames").get<int>();
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;
    }
    return run;
}

}  // namespace weft
