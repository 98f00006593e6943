#pragma once

#include <string>
#include <string_view>

#include "simulation/mesh/tet_mesh.h"

namespace weft {

/// Reads the vertices and tetrahedra of a Gmsh (.msh) or legacy VTK (.vtk) file, by its name's
/// ending. Points, lines and surface elements are passed over; other solid elements are refused.
/// Throws UserError, with the line, where the file is missing, unreadable, empty, binary or cut
/// off, and for a coordinate that is not a finite number, a tetrahedron that names a vertex that is
/// not there or one twice, and a file without tetrahedra. What else can be wrong is for
/// tet_checks.h to see.
TetMesh read_tetrahedra(const std::string& path);

/// Gmsh's ASCII formats 2 to 2.2 and 4.1. `path` stands in messages.
TetMesh parse_msh(std::string_view text, const std::string& path);

/// An ASCII unstructured grid of VTK's legacy format, version 1 to 5: cells as lists of their
/// points, or (from 5.1 on) as OFFSETS and CONNECTIVITY.
TetMesh parse_vtk(std::string_view text, const std::string& path);

}  // namespace weft
