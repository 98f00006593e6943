#include "simulation/bodies/obstacle_mesh.h"

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/bodies/cloth_mesh.h"
#include "simulation/bodies/frame_files.h"
#include "simulation/bodies/selection.h"
#include "simulation/mesh/mesh_checks.h"
#include "simulation/mesh/obj_reader.h"

namespace weft {

/// With frames, the start is the first of them.
TriangleMesh build_obstacle_mesh(const MeshObstacle& obstacle, Warnings& warnings) {
    TriangleMesh mesh = make_triangle_mesh(obstacle.shape, warnings);
    if (std::holds_alternative<MeshFile>(obstacle.shape)) warn_of_odd_topology(mesh, warnings);
    place(mesh.positions, obstacle.transform);
    warn_of_missing_frames(obstacle, warnings);
    auto frames = read_obstacle_frames(obstacle, mesh);
    if (!frames.empty()) mesh.positions = std::move(frames.front());
    check_areas(mesh);
    return mesh;
}

std::vector<std::vector<Vec3>> read_obstacle_frames(const MeshObstacle& obstacle,
                                                    const TriangleMesh& mesh) {
    std::vector<std::vector<Vec3>> frames;
    for (const std::string& path : frame_files(obstacle)) {
        Warnings of_mesh;  // these have been said of the mesh itself
        std::vector<Vec3> positions = read_obj(path, of_mesh).positions;
        if (positions.size() != mesh.positions.size()) {
            throw UserError(fmt::format("{}: {} vertices, and obstacle '{}' has {}", path,
                                        positions.size(), obstacle.name, mesh.positions.size()));
        }
        place(positions, obstacle.transform);
        frames.push_back(std::move(positions));
    }
    return frames;
}

}  // namespace weft
