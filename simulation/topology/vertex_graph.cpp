#include "simulation/topology/vertex_graph.h"

#include <vector>

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

/// The others come one by one, so that nothing has to be sorted, and who comes again does so next.
VertexGraph::VertexGraph(int vertex_count, std::span<const Stencils> kinds) {
    std::vector<Grouped<int>> elements;
    for (const Stencils& kind : kinds) elements.push_back(elements_at_vertices(vertex_count, kind));
    neighbours_ = Grouped<int>(vertex_count, [&](const auto& put) {
        std::vector<int> last(static_cast<std::size_t>(vertex_count), -1);
        for (int other = 0; other < vertex_count; ++other) {
            last[static_cast<std::size_t>(other)] = other;
            for (std::size_t k = 0; k < kinds.size(); ++k) {
                for (const int e : elements[k][other]) {
                    for (const int v : kinds[k][e]) {
                        int& known = last[static_cast<std::size_t>(v)];
                        if (known != other) put(v, other);
                        known = other;
                    }
                }
            }
        }
    });
}

}  // namespace weft
