#include "simulation/mesh/tet_reader.h"

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/mesh/mesh_format.h"
#include "simulation/mesh/mesh_text.h"

namespace weft {

TetMesh read_tetrahedra(const std::string& path) {
    const std::string format = mesh_format(path);
    if (format == "Gmsh") return parse_msh(read_mesh_text(path, "a Gmsh mesh"), path);
    if (format == "legacy VTK") return parse_vtk(read_mesh_text(path, "a VTK mesh"), path);
    throw UserError(
        fmt::format("{}: {}a solid's mesh must be a Gmsh (.msh) or legacy VTK (.vtk) file", path,
                    other_format(path)));
}

}  // namespace weft
