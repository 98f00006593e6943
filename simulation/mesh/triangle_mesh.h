#pragma once

#include <array>
#include <string>
#include <vector>

#include "simulation/mesh/vec3.h"

namespace weft {

/// Things worth saying that do not stop anything. Whoever holds the list decides how to say them.
using Warnings = std::vector<std::string>;

/// A named range of triangles (a group or object of an OBJ file).
struct MeshPart {
    std::string name;
    int first_triangle = 0;
    int triangle_count = 0;
};

/// Triangles over shared vertices. The order of vertices is that of the file or the generator, and
/// never changes: state hashes and geometry files use it.
struct TriangleMesh {
    std::vector<Vec3> positions;                ///< [m]
    std::vector<std::array<int, 3>> triangles;  ///< vertex indices, counter-clockwise from outside
    std::vector<MeshPart> parts;                ///< cover all triangles, in order
    std::string source;                         ///< file name, or "grid", "cylinder"

    int vertex_count() const { return static_cast<int>(positions.size()); }
    int triangle_count() const { return static_cast<int>(triangles.size()); }
};

}  // namespace weft
