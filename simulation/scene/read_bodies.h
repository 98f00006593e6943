#pragma once

#include <string>
#include <vector>

#include "simulation/scene/document.h"
#include "simulation/scene/scene.h"

/// Cloths, solids and obstacles of triangles out of a checked document. Throw UserError.
namespace weft {

/// scene_path: mesh files are relative to its folder. All but the name.
Cloth read_cloth(const Node& table, const std::string& scene_path);
Solid read_solid(const Node& table, const std::string& scene_path);

/// The body and its copies, as the table's `copies` has them; named already.
template <class Body>
std::vector<Body> read_copies(const Node& table, const Body& body);

/// scene: has its path and its dt already. All but the name and the parent.
MeshObstacle read_mesh_obstacle(const Node& table, const Scene& scene);

}  // namespace weft
