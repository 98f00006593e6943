#include "simulation/mesh/tet_reader.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/mesh/mesh_text.h"

namespace weft {

TetMesh read_tetrahedra(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending == ".msh") return parse_msh(read_mesh_text(path, "a Gmsh mesh"), path);
    if (ending == ".vtk") return parse_vtk(read_mesh_text(path, "a VTK mesh"), path);
    throw UserError(
        fmt::format("{}: a solid's mesh must be a Gmsh (.msh) or legacy VTK (.vtk) file", path));
}

}  // namespace weft
