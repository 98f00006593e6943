#pragma once

#include <array>
#include <span>
#include <vector>

#include "simulation/mesh/triangle_mesh.h"

namespace weft {

/// How far apart vertices may lie that are to become one, [vertices] [m]: a hundredth of the
/// shortest edge at each. So vertices that an edge joins are never in one place. 0: no triangle.
std::vector<double> weld_reach(const TriangleMesh& mesh);

/// Vertices of the border (edges of one triangle) that lie in one place, within the reach of both.
/// reach  as weld_reach() has it
std::vector<std::array<int, 2>> coincident_border(const TriangleMesh& mesh,
                                                  std::span<const double> reach);

/// Makes the two vertices of every pair one vertex, at the place of the lower one and with its
/// number; the numbers behind those that are gone move up, and `mesh.welded` says what each became.
/// Triangles, parts, texture and rest shape stay as they are. Throws UserError where a triangle
/// would lose its area, or two would have the same corners.
/// where  for messages
void weld(TriangleMesh& mesh, std::span<const std::array<int, 2>> pairs, const std::string& where);

}  // namespace weft
