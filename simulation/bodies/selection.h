#pragma once

#include <span>
#include <string>
#include <vector>

#include "simulation/mesh/triangle_mesh.h"
#include "simulation/scene/scene.h"

namespace weft {

/// The vertices that a selection names, ascending, each once.
/// shape      of the body
/// positions  its vertices in the world at time 0 [m]
/// parts      its named parts
/// whose      for messages: "pins of cloth 'sheet'"
/// Throws UserError where an index is out of range, a box has no vertex inside, or no part has the
/// name.
std::vector<int> selected_vertices(const Selection& selection, const Shape& shape,
                                   std::span<const Vec3> positions, const NamedVertices& parts,
                                   const std::string& whose);

/// Scales, rotates and moves a shape's vertices to their place in the world.
void place(std::span<Vec3> positions, const Transform& transform);

}  // namespace weft
