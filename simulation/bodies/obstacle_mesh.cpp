#include "simulation/bodies/obstacle_mesh.h"

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/bodies/cloth_mesh.h"
#include "simulation/bodies/dataset_frames.h"
#include "simulation/bodies/frame_files.h"
#include "simulation/bodies/selection.h"
#include "simulation/mesh/mesh_checks.h"
#include "simulation/mesh/obj_reader.h"

namespace weft {
namespace {

std::vector<std::vector<Vec3>> read_frames(const MeshObstacle& obstacle, const TriangleMesh& mesh) {
    if (const auto dataset = frame_dataset(obstacle)) {
        return read_dataset_frames(obstacle, *dataset, mesh.positions.size());
    }
    std::vector<std::vector<Vec3>> frames;
    for (const std::string& path : frame_files(obstacle)) {
        Warnings of_mesh;  // these have been said of the mesh itself
        std::vector<Vec3> positions = read_obj(path, of_mesh).positions;
        if (positions.size() != mesh.positions.size()) {
            throw UserError(fmt::format("{}: {} vertices, and obstacle '{}' has {}", path,
                                        positions.size(), obstacle.name, mesh.positions.size()));
        }
        frames.push_back(std::move(positions));
    }
    return frames;
}

}  // namespace

/// With frames, the start is the first of them.
ObstacleMesh build_obstacle_mesh(const MeshObstacle& obstacle, Warnings& warnings) {
    ObstacleMesh built{make_triangle_mesh(obstacle.shape, warnings)};
    TriangleMesh& mesh = built.mesh;
    if (std::holds_alternative<MeshFile>(obstacle.shape)) warn_of_odd_topology(mesh, warnings);
    place(mesh.positions, obstacle.transform);
    warn_of_missing_frames(obstacle, warnings);
    built.frames = read_frames(obstacle, mesh);
    for (std::vector<Vec3>& frame : built.frames) place(frame, obstacle.transform);
    if (!built.frames.empty()) mesh.positions = built.frames.front();
    check_areas(mesh);
    return built;
}

}  // namespace weft
