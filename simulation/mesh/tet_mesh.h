#pragma once

#include <array>
#include <string>
#include <vector>

#include "simulation/mesh/triangle_mesh.h"

namespace weft {

/// Tetrahedra over shared vertices. The order of vertices is that of the file or the generator, and
/// never changes: state hashes and geometry files use it.
struct TetMesh {
    std::vector<Vec3> positions;  ///< [m]
    /// Vertex indices; seen from vertex 0, the vertices 1, 2, 3 turn clockwise (positive volume).
    std::vector<std::array<int, 4>> tetrahedra;
    std::string source;  ///< file name, or "block"

    int vertex_count() const { return static_cast<int>(positions.size()); }
    int tetrahedron_count() const { return static_cast<int>(tetrahedra.size()); }
};

/// Six times the volume, negative where it is inverted [m^3].
inline double six_volumes(const TetMesh& mesh, const std::array<int, 4>& t) {
    const auto corner = [&](std::size_t k) {
        return mesh.positions[static_cast<std::size_t>(t[k])];
    };
    const Vec3 origin = corner(0);
    return dot(cross(corner(1) - origin, corner(2) - origin), corner(3) - origin);
}

/// The faces that only one tetrahedron has, counter-clockwise from outside, in the order of their
/// tetrahedra.
std::vector<std::array<int, 3>> boundary_faces(const TetMesh& mesh);

}  // namespace weft
