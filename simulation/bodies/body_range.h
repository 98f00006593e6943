#pragma once

#include <string>

#include "simulation/mesh/triangle_mesh.h"

namespace weft {

/// A range of the scene's vertices that belongs to one cloth or solid.
struct BodyRange {
    std::string name;
    std::string kind;  ///< "cloth", "solid" or "obstacle"
    int first_vertex = 0;
    int vertex_count = 0;
    NamedVertices parts{};  ///< by the body's own numbers
};

}  // namespace weft
