#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "simulation/mesh/vec3.h"

namespace weft {

/// Things worth saying that do not stop anything. Whoever holds the list decides how to say them.
using Warnings = std::vector<std::string>;

/// A named range of triangles (a group or object of an OBJ file).
struct MeshPart {
    std::string name;  ///< of its group, or its object's where it has none
    int first_triangle = 0;
    int triangle_count = 0;
    std::string object{};
};

/// Triangles over shared vertices. The order of vertices is that of the file or the generator, and
/// never changes: state hashes and geometry files use it.
struct TriangleMesh {
    std::vector<Vec3> positions;                ///< [m]
    std::vector<std::array<int, 3>> triangles;  ///< vertex indices, counter-clockwise from outside
    std::vector<MeshPart> parts;                ///< cover all triangles, in order
    std::string source;                         ///< file name, or "grid", "cylinder"
    /// [triangles] u and v of each corner; empty: the file has none, or not of all faces
    std::vector<std::array<std::array<double, 2>, 3>> texture{};
    /// [triangles] where their corners are at rest, triangle by triangle: neighbours need not fit
    /// together (flat panels). Empty: as they are in `positions`.
    std::vector<std::array<Vec3, 3>> rest{};
    std::string rest_source{};  ///< file name of the rest shape
    /// [vertices of the file] which vertex each has become; empty: itself. See weld.h.
    std::vector<int> welded{};

    /// The corners of a triangle at rest [m].
    std::array<Vec3, 3> rest_of(std::size_t triangle) const;
    /// A vertex's number in the file; of a welded one the first that it had there.
    int number_in_file(int vertex) const;
    int vertex_count() const { return static_cast<int>(positions.size()); }
    int triangle_count() const { return static_cast<int>(triangles.size()); }
};

/// Vertices by the name of a part, ascending, each once.
using NamedVertices = std::map<std::string, std::vector<int>>;

/// The vertices of every object and group. A group whose name is several words, as OBJ has it, is
/// found by all of it and by each word.
NamedVertices named_parts(const TriangleMesh& mesh);

}  // namespace weft
