#include "simulation/topology/vertex_layout.h"

#include "simulation/topology/vertex_groups.h"

namespace weft {

VertexLayout make_vertex_layout(std::span<const Stencils> kinds, const Strips& strips) {
    const VertexGraph graph(static_cast<int>(strips.order.size()), kinds);
    VertexLayout layout;
    layout.vertices = sort_into_segments(graph, strips, find_places(graph, strips),
                                         Groups(graph.vertex_count()), layout);
    return layout;
}

}  // namespace weft
