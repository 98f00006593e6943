#pragma once

#include <span>
#include <vector>

#include "simulation/topology/stencils.h"

namespace weft {

/// Which vertices share an element with which.
class VertexGraph {
public:
    VertexGraph(int vertex_count, std::span<const Stencils> kinds);

    int vertex_count() const { return static_cast<int>(begin_.size()) - 1; }
    /// Ascending, without the vertex itself.
    std::span<const int> neighbours(int vertex) const {
        const auto v = static_cast<std::size_t>(vertex);
        return {neighbours_.data() + begin_[v], neighbours_.data() + begin_[v + 1]};
    }

private:
    std::vector<int> begin_;
    std::vector<int> neighbours_;
};

}  // namespace weft
