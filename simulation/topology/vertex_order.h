#pragma once

#include <span>
#include <vector>

#include "simulation/topology/stencils.h"

namespace weft {

/// All vertices, component by component, each by breadth-first levels.
struct VertexOrder {
    std::vector<int> order;        ///< [vertex_count] new vertex -> old vertex
    std::vector<int> level_begin;  ///< [level_count + 1] first new vertex of each, and vertex_count
};

/// Orders components by their lowest vertex, and each by breadth-first levels from a vertex at its
/// far end (George and Liu 1979), so that there are many levels and each is small.
///
/// Neighbours are the vertices of one element; but an element whose vertices already hang together
/// by a kind of lower arity adds none. So hinges on springs leave the levels of the springs, which
/// are finer and give a choice of more places to cut.
VertexOrder order_vertices(int vertex_count, std::span<const Stencils> kinds);

}  // namespace weft
