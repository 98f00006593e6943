#pragma once

#include <vector>

#include "simulation/mesh/triangle_mesh.h"
#include "simulation/scene/scene.h"

namespace weft {

/// The surface of an obstacle, placed in the world.
struct ObstacleMesh {
    TriangleMesh mesh;  ///< as it is at time 0
    /// [frames][vertices] where motion.frames has its vertices; empty: it has none
    std::vector<std::vector<Vec3>> frames{};
};

/// Throws UserError, also where a frame has another number of vertices than the mesh; adds to
/// `warnings`.
ObstacleMesh build_obstacle_mesh(const MeshObstacle& obstacle, Warnings& warnings);

}  // namespace weft
