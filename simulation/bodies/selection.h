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
/// welded     what the vertices of its file have become (TriangleMesh::welded): listed vertices
///            have the numbers of the file
/// whose      for messages: "pins of cloth 'sheet'"
/// Throws UserError where an index is out of range, a box has no vertex inside, or no part has the
/// name.
std::vector<int> selected_vertices(const Selection& selection, const Shape& shape,
                                   std::span<const Vec3> positions, const NamedVertices& parts,
                                   const std::string& whose, std::span<const int> welded = {});

/// Whether it names vertices by their numbers, and nothing else.
bool lists_vertices_alone(const Selection& selection);

/// Its listed vertices in the order written, by the mesh's own numbers.
std::vector<int> listed_vertices(const Selection& selection, std::span<const int> welded);

/// Scales, rotates and moves a shape's vertices to their place in the world.
void place(std::span<Vec3> positions, const Transform& transform);

}  // namespace weft
