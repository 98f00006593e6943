#include "simulation/topology/vertex_layout.h"

#include <algorithm>
#include <functional>

#include "simulation/topology/vertex_groups.h"

namespace weft {

VertexLayout make_vertex_layout(std::span<const Stencils> kinds, const Strips& strips) {
    return make_vertex_layout(VertexGraph(static_cast<int>(strips.order.size()), kinds), strips);
}

VertexLayout make_vertex_layout(const VertexGraph& graph, const Strips& strips) {
    VertexLayout layout;
    layout.vertices = sort_into_segments(graph, strips, find_places(graph, strips),
                                         Groups(graph.vertex_count()), layout);
    // Rows of elements that share a pack are about as long then.
    const auto neighbours = [&](int v) { return graph.neighbours(v).size(); };
    for (std::size_t s = 0; s + 1 < layout.segment_begin.size(); ++s) {
        std::ranges::stable_sort(layout.vertices.begin() + layout.segment_begin[s],
                                 layout.vertices.begin() + layout.segment_begin[s + 1],
                                 std::greater{}, neighbours);
    }
    return layout;
}

}  // namespace weft
