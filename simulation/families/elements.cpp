#include "simulation/families/elements.h"

#include <algorithm>

namespace weft {

Elements::Elements(const std::string& name, const Stencils& stencils, const Strips& strips)
    : layout_(make_layout(stencils, strips)),
      vertices_(name + ".vertices", layout_.stencils.vertices.size()),
      segment_begin_(name + ".segments", layout_.segment_begin.size()) {
    std::copy(layout_.segment_begin.begin(), layout_.segment_begin.end(), segment_begin_.data());
    const auto rows = static_cast<std::size_t>(count());
    const auto columns = static_cast<std::size_t>(arity());
    for (std::size_t e = 0; e < rows; ++e) {
        for (std::size_t k = 0; k < columns; ++k) {
            vertices_[k * rows + e] = layout_.stencils.vertices[e * columns + k];
        }
    }
    for (int phase = 0; phase < kPhaseCount; ++phase) {
        segments_[static_cast<std::size_t>(phase)] = {
            &segment_begin_, layout_.segment(phase, 0, 0),
            layout_.colour_count[static_cast<std::size_t>(phase)], layout_.strip_count};
    }
}

}  // namespace weft
