#include "apps/weft/run/run_geometry.h"

#include <fmt/format.h>

#include "runtime/error.h"
#include "runtime/unused_memory.h"

namespace weft {
namespace {

std::vector<GeometryBody> geometry_bodies(const Model& model) {
    std::vector<GeometryBody> bodies;
    for (const BodyRange& body : model.bodies) {
        bodies.push_back({body.name, static_cast<std::uint32_t>(body.triangle_count)});
    }
    return bodies;
}

std::vector<GeometryWriter::Triangle> geometry_triangles(const Model& model) {
    std::vector<GeometryWriter::Triangle> triangles;
    triangles.reserve(model.triangles.size());
    const auto index = [](int vertex) { return static_cast<std::uint32_t>(vertex); };
    for (const auto& t : model.triangles)
        triangles.push_back({index(t[0]), index(t[1]), index(t[2])});
    return triangles;
}

}  // namespace

std::size_t geometry_states(const Scene& scene, int frames) {
    return static_cast<std::size_t>(frames / scene.output.every) + 1;
}

/// Their file is laid out in advance, with some 500 bytes for each of them.
void check_geometry_states(const Scene& scene, const std::string& path) {
    constexpr std::size_t kMost = 1'000'000;
    const std::size_t states = geometry_states(scene, scene.frames);
    if (states <= kMost) return;
    throw UserError(
        fmt::format("{}: geometry would have {} states, and the most are {}; a larger "
                    "[output] every leaves some out, --no-geometry all of them",
                    path, states, kMost));
}

RunGeometry::RunGeometry(const std::filesystem::path& path, const Scene& scene, const Model& model)
    : every_(scene.output.every),
      writer_(path, geometry_triangles(model), static_cast<std::size_t>(model.vertex_count()),
              geometry_bodies(model), geometry_states(scene, scene.frames),
              scene.output.compression) {
    give_back_freed();  // copies of all triangles
}

void RunGeometry::append(const Simulation& simulation) {
    if (simulation.frame() % every_ != 0) return;
    writer_.append(simulation.time(),
                   [model = simulation.shared_model(), state = simulation.snapshot()] {
                       return model->in_scene(state->ordered_positions(*model));
                   });
}

}  // namespace weft
