#include "apps/weft/trace/recorded_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "runtime/error.h"
#include "simulation/bodies/mesh_files.h"
#include "simulation/scene/read_scene.h"

namespace weft {

namespace {

std::string value_of(const TextPairs& pairs, const std::string& name) {
    const auto found = std::find_if(pairs.begin(), pairs.end(),
                                    [&](const auto& pair) { return pair.first == name; });
    return found == pairs.end() ? "" : found->second;
}

/// One to a line.
std::vector<Override> recorded_overrides(const RunDescription& run) {
    std::vector<Override> list;
    std::istringstream lines(recorded_setting(run, "set"));
    for (std::string line; std::getline(lines, line);) {
        list.push_back({line, "recorded setting " + line});
    }
    return list;
}

void check_mesh(const BodyMesh& mesh, const std::string& recorded) {
    for (const std::string& path : mesh.files) {
        if (std::filesystem::exists(path)) continue;
        throw UserError(
            fmt::format("{}: the mesh file of {} is not there any more; --scene FILE "
                        "says where the scene file is now",
                        path, mesh.body));
    }
    const std::string hash = mesh_hash(mesh);
    if (hash == recorded) return;
    const bool is_sequence = mesh.files.size() > 1;
    throw UserError(fmt::format(
        "{}: the mesh file of {} has changed since the run{}: its hash was {}, and is {}",
        mesh.named, mesh.body,
        is_sequence ? fmt::format(", or is not one of these {}", mesh.files.size()) : "", recorded,
        hash));
}

}  // namespace

std::string recorded_setting(const RunDescription& run, const std::string& name) {
    return value_of(run.settings, name);
}

Scene recorded_scene(const RunDescription& run, const std::optional<std::string>& scene_path) {
    Scene scene =
        parse_scene(run.scene_text, scene_path.value_or(run.scene_path), recorded_overrides(run));
    for (const BodyMesh& mesh : mesh_files(scene)) {
        check_mesh(mesh, value_of(run.meshes, mesh.body));
    }
    return scene;
}

}  // namespace weft
