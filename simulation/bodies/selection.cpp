#include "simulation/bodies/selection.h"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/error.h"
#include "runtime/near_miss.h"

namespace weft {
namespace {

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

int corner_vertex(const BlockShape& block, const std::string& corner) {
    const auto [nx, ny, nz] = block.resolution;
    const int i = corner[1] == '+' ? nx - 1 : 0;
    const int j = corner[3] == '+' ? ny - 1 : 0;
    const int k = corner[5] == '+' ? nz - 1 : 0;
    return (k * ny + j) * nx + i;
}

int corner_vertex(const Shape& shape, const std::string& corner) {
    if (const auto* grid = std::get_if<GridShape>(&shape)) return corner_vertex(*grid, corner);
    return corner_vertex(std::get<BlockShape>(shape), corner);
}

void add_edge(const GridShape& grid, const std::string& edge, std::vector<int>& vertices) {
    const auto [nx, nz] = grid.resolution;
    const bool is_along_z = edge[0] == 'x';
    const int count = is_along_z ? nz : nx;
    for (int i = 0; i < count; ++i) {
        const int last = edge[1] == '-' ? 0 : is_along_z ? nx - 1 : nz - 1;
        vertices.push_back(is_along_z ? i * nx + last : last * nx + i);
    }
}

void add_rim(const CylinderShape& cylinder, const std::string& rim, std::vector<int>& vertices) {
    const auto [around, along] = cylinder.resolution;
    const int first = rim == "top" ? 0 : around * (along - 1);
    for (int i = 0; i < around; ++i) vertices.push_back(first + i);
}

void add_face(const BlockShape& block, const std::string& face, std::vector<int>& vertices) {
    const auto [nx, ny, nz] = block.resolution;
    const auto axis = static_cast<std::size_t>(face[0] - 'x');
    const int at = face[1] == '+' ? block.resolution[axis] - 1 : 0;
    for (int v = 0; v < nx * ny * nz; ++v) {
        const std::array<int, 3> place{v % nx, v / nx % ny, v / (nx * ny)};
        if (place[axis] == at) vertices.push_back(v);
    }
}

void add_box(const Box3& box, const std::string& where, std::span<const Vec3> positions,
             std::vector<int>& vertices) {
    const std::size_t before = vertices.size();
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (contains(box, positions[v])) vertices.push_back(static_cast<int>(v));
    }
    if (vertices.size() > before) return;
    throw UserError(fmt::format("{}: no vertex starts inside the box [[{}, {}, {}], [{}, {}, {}]]",
                                where, box.low.x, box.low.y, box.low.z, box.high.x, box.high.y,
                                box.high.z));
}

void add_part(const std::string& part, const NamedVertices& parts, const std::string& where,
              std::vector<int>& vertices) {
    const auto found = parts.find(part);
    if (found != parts.end()) {
        vertices.insert(vertices.end(), found->second.begin(), found->second.end());
        return;
    }
    if (parts.empty()) {
        throw UserError(
            fmt::format("{}: parts = '{}': the mesh has no named parts ('o' and 'g' "
                        "lines)",
                        where, part));
    }
    std::vector<std::string> names;
    for (const auto& [name, of_part] : parts) names.push_back(name);
    throw UserError(fmt::format("{}: parts = '{}': the mesh has no such part; {}", where, part,
                                near_miss_or_list(part, names)));
}

}  // namespace

std::vector<int> selected_vertices(const Selection& selection, const Shape& shape,
                                   std::span<const Vec3> positions, const NamedVertices& parts,
                                   const std::string& whose, std::span<const int> welded) {
    const std::string where = fmt::format("{}: {}", selection.where, whose);
    const std::size_t count = welded.empty() ? positions.size() : welded.size();
    for (const int vertex : selection.vertices) {
        if (vertex >= 0 && static_cast<std::size_t>(vertex) < count) continue;
        throw UserError(
            fmt::format("{}: vertex {} is out of range: the mesh has {} vertices, "
                        "counted from 0",
                        where, vertex, count));
    }
    std::vector<int> vertices = listed_vertices(selection, welded);
    for (const std::string& corner : selection.corners) {
        vertices.push_back(corner_vertex(shape, corner));
    }
    for (const std::string& edge : selection.edges) {
        add_edge(std::get<GridShape>(shape), edge, vertices);
    }
    for (const std::string& rim : selection.rims) {
        add_rim(std::get<CylinderShape>(shape), rim, vertices);
    }
    for (const std::string& face : selection.faces) {
        add_face(std::get<BlockShape>(shape), face, vertices);
    }
    for (const std::string& part : selection.parts) add_part(part, parts, where, vertices);
    for (const Box3& box : selection.boxes) add_box(box, where, positions, vertices);
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

bool lists_vertices_alone(const Selection& s) {
    return s.edges.empty() && s.corners.empty() && s.rims.empty() && s.parts.empty() &&
           s.boxes.empty();
}

std::vector<int> listed_vertices(const Selection& selection, std::span<const int> welded) {
    std::vector<int> vertices = selection.vertices;
    if (welded.empty()) return vertices;
    for (int& vertex : vertices) vertex = welded[static_cast<std::size_t>(vertex)];
    return vertices;
}

void place(std::span<Vec3> positions, const Transform& transform) {
    Mat3 rotation;
    for (const Rotation& r : transform.rotations) {
        rotation = rotation_matrix(r.axis, r.degrees) * rotation;
    }
    const Vec3 s = transform.scale;
    for (Vec3& p : positions) {
        p = rotation * Vec3{s.x * p.x, s.y * p.y, s.z * p.z} + transform.translate;
    }
}

}  // namespace weft
