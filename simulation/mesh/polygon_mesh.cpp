#include "simulation/mesh/polygon_mesh.h"

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/mesh/polygon.h"

namespace weft {
namespace {

std::vector<std::array<int, 3>> split_face(const PolygonMesh& mesh, std::span<const int> face) {
    if (face.size() == 3) return {{0, 1, 2}};
    std::vector<Vec3> corners;
    for (const int vertex : face) {
        corners.push_back(mesh.positions[static_cast<std::size_t>(vertex)]);
    }
    return split_polygon(corners);
}

}  // namespace

FaceSplit split_faces(const PolygonMesh& mesh, std::span<const std::size_t> line_of) {
    FaceSplit split;
    split.triangles.reserve(mesh.corners.size() / 3);
    split.triangle_begin.reserve(mesh.face_begin.size());
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const auto triangles = split_face(mesh, mesh.face(f));
        if (triangles.empty()) {
            throw UserError(
                fmt::format("{}:{}: face with {} corners crosses itself or has no "
                            "area: it cannot be split into triangles",
                            mesh.source, line_of[f], mesh.face(f).size()));
        }
        const std::size_t first = mesh.face_begin[f];
        for (const auto& t : triangles) {
            split.triangles.push_back({first + static_cast<std::size_t>(t[0]),
                                       first + static_cast<std::size_t>(t[1]),
                                       first + static_cast<std::size_t>(t[2])});
        }
        split.triangle_begin.push_back(split.triangles.size());
    }
    return split;
}

namespace {

void add_texture(const PolygonMesh& mesh, const FaceSplit& split, TriangleMesh& result) {
    const auto at = [&](std::size_t corner) {
        return mesh.texture[static_cast<std::size_t>(mesh.texture_corners[corner])];
    };
    result.texture.reserve(split.triangles.size());
    for (const auto& [a, b, c] : split.triangles) result.texture.push_back({at(a), at(b), at(c)});
}

}  // namespace

TriangleMesh triangles_of(const PolygonMesh& mesh, const FaceSplit& split) {
    TriangleMesh result;
    result.source = mesh.source;
    result.positions = mesh.positions;
    result.triangles.reserve(split.triangles.size());
    for (const auto& [a, b, c] : split.triangles) {
        result.triangles.push_back({mesh.corners[a], mesh.corners[b], mesh.corners[c]});
    }
    if (!mesh.texture_corners.empty()) add_texture(mesh, split, result);
    for (const PolygonMesh::Part& part : mesh.parts) {
        const std::size_t first = split.triangle_begin[part.first_face];
        const std::size_t last = split.triangle_begin[part.first_face + part.face_count];
        result.parts.push_back({part.group.empty() ? part.object : part.group,
                                static_cast<int>(first), static_cast<int>(last - first),
                                part.object});
    }
    return result;
}

}  // namespace weft
