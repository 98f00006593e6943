#pragma once

#include "simulation/mesh/triangle_mesh.h"
#include "simulation/scene/scene.h"

namespace weft {

/// Makes vertices of a cloth's placed mesh one where the scene wants it: `weld` of the cloth, and
/// seams. Throws UserError where a seam's edges do not lie together; adds to `warnings`.
void weld_cloth(TriangleMesh& mesh, const Cloth& cloth, Warnings& warnings);

}  // namespace weft
