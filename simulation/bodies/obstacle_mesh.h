#pragma once

#include <vector>

#include "simulation/mesh/triangle_mesh.h"
#include "simulation/scene/scene.h"

namespace weft {

/// The surface of an obstacle, placed in the world as it is at time 0. Throws UserError; adds to
/// `warnings`.
TriangleMesh build_obstacle_mesh(const MeshObstacle& obstacle, Warnings& warnings);

/// [frames][vertices] where its files have its vertices, placed in the world; empty: it has none.
/// Throws UserError where one has another number of vertices than the mesh.
std::vector<std::vector<Vec3>> read_obstacle_frames(const MeshObstacle& obstacle,
                                                    const TriangleMesh& mesh);

}  // namespace weft
