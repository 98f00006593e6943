#include "simulation/mesh/triangle_mesh.h"

#include <algorithm>
#include <set>
#include <sstream>

namespace weft {
namespace {

std::set<std::string> names_of(const MeshPart& part) {
    std::set<std::string> names{part.object, part.name};
    std::istringstream words(part.name);
    for (std::string word; words >> word;) names.insert(word);
    names.erase("");
    return names;
}

}  // namespace

std::array<Vec3, 3> TriangleMesh::rest_of(std::size_t triangle) const {
    if (!rest.empty()) return rest[triangle];
    const auto& [a, b, c] = triangles[triangle];
    const auto at = [&](int vertex) { return positions[static_cast<std::size_t>(vertex)]; };
    return {at(a), at(b), at(c)};
}

int TriangleMesh::number_in_file(int vertex) const {
    if (welded.empty()) return vertex;
    return static_cast<int>(std::find(welded.begin(), welded.end(), vertex) - welded.begin());
}

NamedVertices named_parts(const TriangleMesh& mesh) {
    NamedVertices parts;
    for (const MeshPart& part : mesh.parts) {
        for (const std::string& name : names_of(part)) {
            std::vector<int>& vertices = parts[name];
            for (int t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
                const auto& corners = mesh.triangles[static_cast<std::size_t>(t)];
                vertices.insert(vertices.end(), corners.begin(), corners.end());
            }
        }
    }
    for (auto& [name, vertices] : parts) {
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    }
    return parts;
}

}  // namespace weft
