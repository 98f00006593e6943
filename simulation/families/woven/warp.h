#pragma once

#include <vector>

#include "simulation/families/woven/woven.h"
#include "simulation/mesh/triangle_mesh.h"
#include "simulation/scene/elements/woven.h"
#include "simulation/scene/scene.h"

namespace weft {

/// [triangles] Where the warp runs: along the scene's vector, or as the mesh has it. A vector is
/// laid into the plane of each triangle. mesh: placed in the world. Throws UserError where the
/// mesh has no direction of its own, and for a triangle to which it is perpendicular.
std::vector<WarpDirection> warp_directions(const Cloth& cloth, const Woven& woven,
                                           const TriangleMesh& mesh);

}  // namespace weft
