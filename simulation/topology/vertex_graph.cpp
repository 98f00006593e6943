#include "simulation/topology/vertex_graph.h"

#include <algorithm>
#include <vector>

#include "runtime/tbb/parallel.h"

namespace weft {

namespace {

/// The elements of a kind at each vertex.
Grouped<int> elements_at_vertices(int vertex_count, const Stencils& kind) {
    return {vertex_count, [&](const auto& put) {
                for (int e = 0; e < kind.count(); ++e) {
                    for (const int v : kind[e]) put(v, e);
                }
            }};
}

}  // namespace

VertexGraph::VertexGraph(int vertex_count, std::span<const Stencils> kinds) {
    std::vector<Grouped<int>> elements(kinds.size());
    for_each_apart(static_cast<int>(kinds.size()),
                   [&](int k) { elements[k] = elements_at_vertices(vertex_count, kinds[k]); });
    const auto find_neighbours = [&](int vertex, std::vector<int>& found) {
        found.clear();
        for (std::size_t k = 0; k < kinds.size(); ++k) {
            for (const int e : elements[k][vertex]) {
                for (const int v : kinds[k][e]) {
                    if (v != vertex) found.push_back(v);
                }
            }
        }
        std::ranges::sort(found);
        found.erase(std::ranges::unique(found).begin(), found.end());
    };
    std::vector<int> counts(static_cast<std::size_t>(vertex_count));
    std::vector<std::vector<int>> rows(static_cast<std::size_t>(block_count(vertex_count)));
    for_each_block(vertex_count, [&](int block, int begin, int end) {
        std::vector<int> found;
        for (int v = begin; v < end; ++v) {
            find_neighbours(v, found);
            counts[v] = static_cast<int>(found.size());
            rows[block].insert(rows[block].end(), found.begin(), found.end());
        }
    });
    neighbours_ = Grouped<int>::of_sizes(vertex_count, [&](int v) { return counts[v]; });
    for_each_block(vertex_count, [&](int block, int begin, int /*end*/) {
        std::ranges::copy(rows[block], neighbours_[begin].data());
    });
}

}  // namespace weft
