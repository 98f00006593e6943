#pragma once

#include <array>
#include <span>
#include <vector>

#include "simulation/topology/vertex_layout.h"

namespace weft {

/// Elements that may become stencils, and in which order they are tried.
struct StencilCandidates {
    Stencils elements;  ///< in new vertices
    std::vector<int> order;
};

/// Stencils as items: the vertices of an element that are computed together, and single
/// vertices. Stencils of one phase and colour share no element.
struct StencilLayout {
    /// The stencils of one kind of element, by the items' segments.
    struct Family {
        int arity = 1;
        std::vector<int> elements;                ///< [stencils]; of single ones, the vertex
        std::vector<int> segment_begin;           ///< [segment_count() + 1] of the stencils
        std::vector<std::array<int, 4>> corners;  ///< [stencils] the items of the first `arity`
    };
    /// Every vertex once. In each segment family by family, corner by corner.
    VertexLayout items;
    std::vector<Family> families;  ///< as the candidates; the last one: single vertices
};

/// Puts as many vertices into stencils as it can, and colours and sorts these. All vertices of a
/// stencil belong to the same phase and strip.
/// kinds       as in make_vertex_layout
/// candidates  the first ones are tried first
StencilLayout make_stencil_layout(std::span<const Stencils> kinds, const Strips& strips,
                                  std::span<const StencilCandidates> candidates);

}  // namespace weft
