#pragma once

#include <cstddef>
#include <string>

#include "simulation/mesh/triangle_mesh.h"

namespace weft {

/// A vertex by its number in scene order: cloth by cloth, then solid by solid. A plain int is one
/// in the order of the buffers; Model::scene_vertex() and vertex() lead from one to the other.
enum class SceneVertex : int {};

constexpr std::size_t index(SceneVertex vertex) { return static_cast<std::size_t>(vertex); }

/// A range of the scene's vertices, and one of its triangles, that belongs to one cloth or solid.
struct BodyRange {
    std::string name;
    std::string kind;  ///< "cloth", "solid" or "obstacle"
    int first_vertex = 0;
    int vertex_count = 0;
    NamedVertices parts{};  ///< by the body's own numbers
    /// [vertices of its file] the body's own numbers, where some are welded; empty: as in the file
    std::vector<int> welded{};
    int first_triangle = 0;
    int triangle_count = 0;

    /// A vertex by the body's own number.
    SceneVertex vertex(int own) const { return SceneVertex{first_vertex + own}; }
    /// The other way; outside [0, vertex_count): it is another body's.
    int own(SceneVertex vertex) const { return static_cast<int>(vertex) - first_vertex; }
    bool has(SceneVertex vertex) const { return own(vertex) >= 0 && own(vertex) < vertex_count; }
};

}  // namespace weft
