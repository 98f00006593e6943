#pragma once

#include <span>

#include "simulation/topology/grouped.h"
#include "simulation/topology/stencils.h"

namespace weft {

/// Which vertices share an element with which.
class VertexGraph {
public:
    VertexGraph(int vertex_count, std::span<const Stencils> kinds);

    int vertex_count() const { return neighbours_.count(); }
    /// Ascending, without the vertex itself.
    std::span<const int> neighbours(int vertex) const { return neighbours_[vertex]; }

private:
    Grouped<int> neighbours_;
};

}  // namespace weft
