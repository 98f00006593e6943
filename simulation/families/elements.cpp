#include "simulation/families/elements.h"

#include <algorithm>

namespace weft {

Elements::Elements(const std::string& name, const Stencils& stencils, const Strips& strips)
    : Elements(name, make_layout(stencils, strips)) {}

Elements::Elements(const std::string& name, ElementLayout layout)
    : arity_(layout.stencils.arity),
      count_(layout.stencils.count()),
      order_(std::move(layout.order)),
      vertices_(name + ".vertices", layout.stencils.vertices.size()),
      segment_begin_(name + ".segments", layout.segment_begin.size()) {
    std::copy(layout.segment_begin.begin(), layout.segment_begin.end(), segment_begin_.data());
    const auto rows = static_cast<std::size_t>(count());
    const auto columns = static_cast<std::size_t>(arity());
    for (std::size_t e = 0; e < rows; ++e) {
        for (std::size_t k = 0; k < columns; ++k) {
            vertices_[k * rows + e] = layout.stencils.vertices[e * columns + k];
        }
    }
    for (int phase = 0; phase < kPhaseCount; ++phase) {
        segments_[static_cast<std::size_t>(phase)] = {
            &segment_begin_, layout.segment(phase, 0, 0),
            layout.colour_count[static_cast<std::size_t>(phase)], layout.strip_count};
    }
}

Stencils Elements::stencils() const {
    Stencils all{arity_, {}};
    all.vertices.reserve(vertices_.count());
    for (int e = 0; e < count_; ++e) {
        const ElementCorners corners = vertices_of(e);
        all.vertices.insert(all.vertices.end(), corners.begin(), corners.end());
    }
    return all;
}

}  // namespace weft
