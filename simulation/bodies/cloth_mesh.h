#pragma once

#include <vector>

#include "simulation/mesh/triangle_mesh.h"
#include "simulation/scene/scene.h"

namespace weft {

/// Generates or reads a mesh of triangles, without the second of two equal ones. Throws UserError;
/// adds to `warnings`.
TriangleMesh make_triangle_mesh(const Shape& shape, Warnings& warnings);

/// Generates or reads the cloth's mesh, places it in the world (rest shape = shape at time 0,
/// unless a file has it), welds it where the scene says so, and checks it. A vertex that no
/// triangle uses stays in the order, at its place, without mass: give it no inverse mass, so that
/// it never moves. Throws UserError; adds to `warnings`.
TriangleMesh build_cloth_mesh(const Cloth& cloth, Warnings& warnings);

/// The vertices of one pin group, ascending, each once. `mesh` is what build_cloth_mesh() gave.
/// Throws UserError where an index is out of range or a selection names nothing.
std::vector<int> pinned_vertices(const Cloth& cloth, const PinGroup& pins,
                                 const TriangleMesh& mesh);

}  // namespace weft
