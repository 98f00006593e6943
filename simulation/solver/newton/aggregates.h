#pragma once

#include <vector>

#include "simulation/model/model.h"
#include "simulation/topology/vertex_graph.h"

namespace weft {

/// Patches of free vertices that hang together, each within a strip, and equally many in each: the
/// coarse space's unknowns. A function of meshes and pins.
struct Aggregates {
    int per_strip = 0;
    std::vector<std::vector<int>> members;  ///< [strips * per_strip]; some may be empty
    /// [vertices] the aggregate; count() for those in none: held ones, and where a strip has more
    /// pieces than there are aggregates
    std::vector<int> of;

    int count() const { return static_cast<int>(members.size()); }
};

/// graph: of all its elements
Aggregates make_aggregates(const Model& model, const VertexGraph& graph);

}  // namespace weft
