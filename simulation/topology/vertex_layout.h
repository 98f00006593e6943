#pragma once

#include <span>
#include <vector>

#include "simulation/topology/layout.h"

namespace weft {

class VertexGraph;

/// All vertices as items of vertex-wise solvers, stored by (phase, strip, colour), and within by
/// number of neighbours, most first, and by vertex. Vertices with an element that crosses between
/// two strips belong to the seam phase, all others to the inner phase.
///
/// Vertices of one phase and colour share no element, in all strips together. Seam s counts as
/// strip s, so the last strip's seam segments are empty. Depends on the mesh only.
struct VertexLayout {
    int strip_count = 0;
    std::array<int, kPhaseCount> colour_count{};
    std::vector<int> vertices;       ///< [items] item -> vertex
    std::vector<int> segment_begin;  ///< [segment_count() + 1], as in ElementLayout

    int segment_count() const { return (colour_count[0] + colour_count[1]) * strip_count; }
    int segment(int phase, int colour, int strip) const {
        const int before = phase == kSeamPhase ? 0 : colour_count[kSeamPhase] * strip_count;
        return before + strip * colour_count[static_cast<std::size_t>(phase)] + colour;
    }
};

/// Colours and sorts the vertices.
/// kinds   all elements, in new vertices; the strips were made with extra_levels >= 1
VertexLayout make_vertex_layout(std::span<const Stencils> kinds, const Strips& strips);
/// Where there is a graph of these elements already.
VertexLayout make_vertex_layout(const VertexGraph& graph, const Strips& strips);

}  // namespace weft
