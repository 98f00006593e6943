#pragma once

#include <span>
#include <vector>

#include "simulation/mesh/triangle_mesh.h"

namespace weft {

/// Vertices along a mesh's border, neighbour by neighbour.
struct BorderChain {
    std::vector<int> vertices;
    bool is_closed = false;  ///< the last one is a neighbour of the first
};

/// The border edges (those of one triangle) of which both ends are selected, joined to chains. They
/// run as their triangles do, and stand in the order of their lowest vertices.
/// selected  [vertices] 1: selected
std::vector<BorderChain> border_chains(const TriangleMesh& mesh, std::span<const char> selected);

}  // namespace weft
