#include "simulation/mesh/tet_mesh.h"

#include <algorithm>

namespace weft {
namespace {

using Face = std::array<int, 3>;

/// The faces of a tetrahedron of positive volume, each counter-clockwise from outside.
constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{
    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

Face face_of(const std::array<int, 4>& tetrahedron, std::size_t face) {
    const auto& [a, b, c] = kFaces[face];
    return {tetrahedron[a], tetrahedron[b], tetrahedron[c]};
}

Face sorted(Face face) {
    std::sort(face.begin(), face.end());
    return face;
}

}  // namespace

std::vector<Face> boundary_faces(const TetMesh& mesh) {
    std::vector<Face> all;
    all.reserve(4 * mesh.tetrahedra.size());
    for (const auto& t : mesh.tetrahedra) {
        for (std::size_t f = 0; f < kFaces.size(); ++f) all.push_back(sorted(face_of(t, f)));
    }
    std::sort(all.begin(), all.end());

    std::vector<Face> boundary;
    for (const auto& t : mesh.tetrahedra) {
        for (std::size_t f = 0; f < kFaces.size(); ++f) {
            const Face face = face_of(t, f);
            const auto [first, last] = std::equal_range(all.begin(), all.end(), sorted(face));
            if (last - first == 1) boundary.push_back(face);
        }
    }
    return boundary;
}

}  // namespace weft
