#pragma once

#include "simulation/mesh/triangle_mesh.h"

namespace weft {

/// Throws UserError for a triangle that has no area, now or at rest, as the kernels' single
/// precision sees it: its edges and bending weights would be made of rounding errors. Call it on
/// positions in the world.
void check_areas(const TriangleMesh& mesh);

/// Drops the second and later of triangles over the same three vertices, with a warning.
void drop_duplicates(TriangleMesh& mesh, Warnings& warnings);

/// Warns of edges with more than two triangles (they keep their spring and get no bending) and of
/// vertices without any (they stay where they are).
void warn_of_odd_topology(const TriangleMesh& mesh, Warnings& warnings);

}  // namespace weft
