#pragma once

#include "simulation/mesh/tet_mesh.h"

namespace weft {

/// Turns inverted tetrahedra right side out by exchanging their last two vertices, with a warning.
void turn_inverted(TetMesh& mesh, Warnings& warnings);

/// Drops the second and later of tetrahedra over the same four vertices, with a warning.
void drop_duplicates(TetMesh& mesh, Warnings& warnings);

/// Warns of faces with more than two tetrahedra (they overlap) and of vertices without any (they
/// stay where they are).
void warn_of_odd_topology(const TetMesh& mesh, Warnings& warnings);

/// Throws UserError for a tetrahedron that has no volume, as the kernels' single precision sees it.
/// Call it on positions in the world.
void check_volumes(const TetMesh& mesh);

}  // namespace weft
