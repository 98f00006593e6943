#include "simulation/scene/cloth_mesh.h"

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/mesh/generators.h"
#include "simulation/mesh/mesh_checks.h"
#include "simulation/mesh/obj_reader.h"
#include "simulation/scene/limits.h"
#include "simulation/scene/selection.h"

namespace weft {
namespace {

TriangleMesh read_checked(const std::string& path, Warnings& warnings) {
    TriangleMesh mesh = read_obj(path, warnings);
    if (mesh.vertex_count() > kMaxVertices) {
        throw UserError(fmt::format("{}: {} vertices are more than the {} that indices can count",
                                    path, mesh.vertex_count(), kMaxVertices));
    }
    drop_duplicates(mesh, warnings);
    warn_of_odd_topology(mesh, warnings);
    return mesh;
}

TriangleMesh make_mesh(const Cloth& cloth, Warnings& warnings) {
    if (const auto* grid = std::get_if<GridShape>(&cloth.shape)) {
        return make_grid(grid->size, grid->resolution);
    }
    if (const auto* cylinder = std::get_if<CylinderShape>(&cloth.shape)) {
        return make_cylinder(cylinder->radius, cylinder->height, cylinder->resolution);
    }
    return read_checked(std::get<MeshFile>(cloth.shape).path, warnings);
}

}  // namespace

TriangleMesh build_cloth_mesh(const Cloth& cloth, Warnings& warnings) {
    TriangleMesh mesh = make_mesh(cloth, warnings);
    place(mesh.positions, cloth.transform);
    check_areas(mesh);
    return mesh;
}

std::vector<int> pinned_vertices(const Cloth& cloth, const PinGroup& pins,
                                 const TriangleMesh& mesh) {
    return selected_vertices(pins, cloth.shape, mesh.positions,
                             fmt::format("pins of cloth '{}'", cloth.name));
}

}  // namespace weft
