#pragma once

#include <array>
#include <string>
#include <vector>

#include "simulation/mesh/tet_mesh.h"
#include "simulation/mesh/triangle_mesh.h"

namespace weft {

/// A flat sheet in the x-z plane, centred at the origin, its triangles facing +y.
/// size [m] along x and z; resolution = vertices along x and z, >= 2.
/// Vertex (i, k) has index k * resolution[0] + i; x grows with i and z with k. Every cell is cut
/// along the same diagonal, from (i + 1, k) to (i, k + 1).
TriangleMesh make_grid(std::array<double, 2> size, std::array<int, 2> resolution);

/// The open side of a cone around the y axis, from y = height/2 down to -height/2, facing outward.
/// radius [m] at the top and at the bottom; resolution = vertices around (>= 3) and from top to
/// bottom (>= 2). Vertex (i, k) has index k * resolution[0] + i; row k = 0 is the top rim, i turns
/// from +x to +z. Cells are cut as in make_grid().
TriangleMesh make_cylinder(std::array<double, 2> radius, double height,
                           std::array<int, 2> resolution);

/// A block of tetrahedra, centred at the origin.
/// size [m] along x, y, z; resolution = vertices along x, y, z, >= 2.
/// Vertex (i, j, k) has index (k * resolution[1] + j) * resolution[0] + i. Every cell is cut alike
/// into 6 tetrahedra around its diagonal from (i, j, k) to (i + 1, j + 1, k + 1) (Freudenthal,
/// Kuhn), so that neighbours fit together whatever the resolution.
TetMesh make_block(std::array<double, 3> size, std::array<int, 3> resolution);

/// Of such a block the cells whose middle is in a '#' of the outline: a picture of the x-y side,
/// rows from the top, all as long. Their vertices keep their order.
TetMesh make_outlined_block(std::array<double, 3> size, std::array<int, 3> resolution,
                            const std::vector<std::string>& outline);
/// How many vertices that has.
double outlined_vertex_count(std::array<int, 3> resolution,
                             const std::vector<std::string>& outline);

}  // namespace weft
