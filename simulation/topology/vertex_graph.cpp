#include "simulation/topology/vertex_graph.h"

#include <algorithm>

namespace weft {

VertexGraph::VertexGraph(int vertex_count, std::span<const Stencils> kinds) {
    const auto count = static_cast<std::size_t>(vertex_count);
    std::vector<std::vector<int>> lists(count);
    for (const Stencils& kind : kinds) {
        for (int e = 0; e < kind.count(); ++e) {
            for (const int v : kind[e]) {
                for (const int other : kind[e]) {
                    if (other != v) lists[static_cast<std::size_t>(v)].push_back(other);
                }
            }
        }
    }
    begin_.push_back(0);
    for (std::vector<int>& list : lists) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
        neighbours_.insert(neighbours_.end(), list.begin(), list.end());
        begin_.push_back(static_cast<int>(neighbours_.size()));
    }
}

}  // namespace weft
