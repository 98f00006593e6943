#include "simulation/topology/vertex_graph.h"

#include <algorithm>

#include "simulation/topology/grouped.h"

namespace weft {

VertexGraph::VertexGraph(int vertex_count, std::span<const Stencils> kinds) {
    Grouped<int> lists(vertex_count, [&](const auto& put) {
        for (const Stencils& kind : kinds) {
            for (int e = 0; e < kind.count(); ++e) {
                for (const int v : kind[e]) {
                    for (const int other : kind[e]) {
                        if (other != v) put(v, other);
                    }
                }
            }
        }
    });
    begin_.push_back(0);
    for (int v = 0; v < vertex_count; ++v) {
        const std::span<int> list = lists[v];
        std::sort(list.begin(), list.end());
        neighbours_.insert(neighbours_.end(), list.begin(), std::unique(list.begin(), list.end()));
        begin_.push_back(static_cast<int>(neighbours_.size()));
    }
}

}  // namespace weft
