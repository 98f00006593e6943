#pragma once

#include <vector>

#include "simulation/mesh/tet_mesh.h"
#include "simulation/scene/scene.h"

namespace weft {

/// Generates or reads the solid's mesh, checks it, turns inverted tetrahedra, and places it in the
/// world (rest shape = shape at time 0). A vertex that no tetrahedron uses stays in the order, at
/// its place, without mass. Throws UserError; adds to `warnings`.
TetMesh build_solid_mesh(const Solid& solid, Warnings& warnings);

/// The vertices of one pin group, ascending, each once. `mesh` is what build_solid_mesh() gave.
/// Throws UserError where an index is out of range or a selection names nothing.
std::vector<int> pinned_vertices(const Solid& solid, const PinGroup& pins, const TetMesh& mesh);

}  // namespace weft
