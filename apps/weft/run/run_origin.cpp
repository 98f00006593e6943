#include "apps/weft/run/run_origin.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "runtime/io/cache_folder.h"
#include "simulation/bodies/mesh_files.h"
#include "simulation/run_description.h"
#include "simulation/solver/async_iterates.h"

namespace weft {
namespace {

/// Asynchronous results depend on the map, which depends on the cuts.
std::string async_origin(const Simulation& simulation, const RunOptions& options) {
    const auto* async = dynamic_cast<const AsyncIterates*>(&simulation.solver());
    if (async == nullptr) return "";
    std::string text = '\n' + to_text(async->settings());
    text += fmt::format("\nstrips {}\nunits", fmt::join(options.strips, ","));
    for (const auto& device : simulation.devices()) {
        text += fmt::format(" {}", device->info().units);
    }
    return text;
}

}  // namespace

std::string request_text(const RunOptions& options, const Scene& scene) {
    std::string text = std::string(WEFT_VERSION) + '\n' + options.math + '\n' + scene.text;
    for (const std::string& value : scene.overrides) {
        if (!value.starts_with("scene.frames=")) text += '\n' + value;
    }
    return text;
}

/// With the meshes, once it is known that they can be read, and what a checkpoint's positions count
/// from.
std::string run_origin(const std::string& request, const RunOptions& options, const Scene& scene,
                       const Simulation& simulation) {
    std::string text = request;
    for (const BodyMesh& mesh : mesh_files(scene)) text += '\n' + mesh_hash(mesh);
    const std::string counted_from = origin_setting(simulation.model());
    if (!counted_from.empty()) text += '\n' + counted_from;
    return cache_key(text + async_origin(simulation, options));
}

}  // namespace weft
