#include "simulation/scene/cloth_mesh.h"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/mesh/generators.h"
#include "simulation/mesh/mesh_checks.h"
#include "simulation/mesh/obj_reader.h"
#include "simulation/scene/limits.h"

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

void place(TriangleMesh& mesh, const Transform& transform) {
    Mat3 rotation;
    for (const Rotation& r : transform.rotations) {
        rotation = rotation_matrix(r.axis, r.degrees) * rotation;
    }
    const Vec3 s = transform.scale;
    for (Vec3& p : mesh.positions) {
        p = rotation * Vec3{s.x * p.x, s.y * p.y, s.z * p.z} + transform.translate;
    }
}

// --- pins
// -----------------------------------------------------------------------------------------

bool contains(const Box3& box, Vec3 p) {
    return box.low.x <= p.x && p.x <= box.high.x && box.low.y <= p.y && p.y <= box.high.y &&
           box.low.z <= p.z && p.z <= box.high.z;
}

int corner_vertex(const GridShape& grid, const std::string& corner) {
    const auto [nx, nz] = grid.resolution;
    const int i = corner[1] == '+' ? nx - 1 : 0;
    const int k = corner[3] == '+' ? nz - 1 : 0;
    return k * nx + i;
}

void add_rim(const CylinderShape& cylinder, const std::string& rim, std::vector<int>& vertices) {
    const auto [around, along] = cylinder.resolution;
    const int first = rim == "top" ? 0 : around * (along - 1);
    for (int i = 0; i < around; ++i) vertices.push_back(first + i);
}

void add_box(const Box3& box, const std::string& where, const TriangleMesh& mesh,
             std::vector<int>& vertices) {
    const std::size_t before = vertices.size();
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        if (contains(box, mesh.positions[v])) vertices.push_back(v);
    }
    if (vertices.size() > before) return;
    throw UserError(
        fmt::format("{}: no vertex of the cloth starts inside the box [[{}, {}, {}], "
                    "[{}, {}, {}]]",
                    where, box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z));
}

}  // namespace

TriangleMesh build_cloth_mesh(const Cloth& cloth, Warnings& warnings) {
    TriangleMesh mesh = make_mesh(cloth, warnings);
    place(mesh, cloth.transform);
    check_areas(mesh);
    return mesh;
}

std::vector<int> pinned_vertices(const Cloth& cloth, const PinGroup& pins,
                                 const TriangleMesh& mesh) {
    const std::string where = fmt::format("{}: pins of cloth '{}'", pins.where, cloth.name);
    std::vector<int> vertices;
    for (const int vertex : pins.vertices) {
        if (vertex < 0 || vertex >= mesh.vertex_count()) {
            throw UserError(
                fmt::format("{}: vertex {} is out of range: the mesh has {} vertices, "
                            "counted from 0",
                            where, vertex, mesh.vertex_count()));
        }
        vertices.push_back(vertex);
    }
    for (const std::string& corner : pins.corners) {
        vertices.push_back(corner_vertex(std::get<GridShape>(cloth.shape), corner));
    }
    for (const std::string& rim : pins.rims) {
        add_rim(std::get<CylinderShape>(cloth.shape), rim, vertices);
    }
    for (const Box3& box : pins.boxes) add_box(box, where, mesh, vertices);
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

}  // namespace weft
