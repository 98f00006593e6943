#include "simulation/bodies/cloth_mesh.h"

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/bodies/mesh_files.h"
#include "simulation/bodies/selection.h"
#include "simulation/bodies/welds.h"
#include "simulation/mesh/generators.h"
#include "simulation/mesh/mesh_checks.h"
#include "simulation/mesh/obj_reader.h"
#include "simulation/scene/limits.h"

namespace weft {
namespace {

TriangleMesh read_checked(const MeshFile& file, Warnings& warnings) {
    check_there(file);
    const std::string& path = file.path;
    TriangleMesh mesh = file.rest.empty() ? read_obj(path, warnings)
                                          : read_obj_with_rest(path, file.rest, warnings);
    if (mesh.vertex_count() > kMaxVertices) {
        throw UserError(fmt::format("{}: {} vertices are more than the {} that indices can count",
                                    path, mesh.vertex_count(), kMaxVertices));
    }
    drop_duplicates(mesh, warnings);
    return mesh;
}

}  // namespace

TriangleMesh make_triangle_mesh(const Shape& shape, Warnings& warnings) {
    if (const auto* grid = std::get_if<GridShape>(&shape)) {
        return make_grid(grid->size, grid->resolution);
    }
    if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
        return make_cylinder(cylinder->radius, cylinder->height, cylinder->resolution);
    }
    return read_checked(std::get<MeshFile>(shape), warnings);
}

TriangleMesh build_cloth_mesh(const Cloth& cloth, Warnings& warnings) {
    TriangleMesh mesh = make_triangle_mesh(cloth.shape, warnings);
    place(mesh.positions, cloth.transform);
    for (auto& corners : mesh.rest) {
        for (Vec3& corner : corners) corner = cloth.transform.scale.x * corner;
    }
    weld_cloth(mesh, cloth, warnings);
    if (std::holds_alternative<MeshFile>(cloth.shape)) warn_of_odd_topology(mesh, warnings);
    check_areas(mesh);
    return mesh;
}

std::vector<int> pinned_vertices(const Cloth& cloth, const PinGroup& pins,
                                 const TriangleMesh& mesh) {
    return selected_vertices(pins, cloth.shape, mesh.positions,
                             pins.parts.empty() ? NamedVertices{} : named_parts(mesh),
                             fmt::format("pins of cloth '{}'", cloth.name), mesh.welded);
}

}  // namespace weft
