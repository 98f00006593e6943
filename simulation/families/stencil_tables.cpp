#include "simulation/families/stencil_tables.h"

#include <algorithm>

namespace weft {

StencilTables::StencilTables(const VertexLayout& items, const StencilLayout::Family& chosen)
    : corners_("stencils.corners", static_cast<std::size_t>(chosen.arity) * chosen.corners.size()),
      segment_begin_("stencils.segments", chosen.segment_begin.size()),
      count_(static_cast<int>(chosen.corners.size())) {
    for (std::size_t i = 0; i < corners_.count(); ++i) {
        corners_[i] = chosen.corners[i % chosen.corners.size()][i / chosen.corners.size()];
    }
    std::copy(chosen.segment_begin.begin(), chosen.segment_begin.end(), segment_begin_.data());
    for (const Phase phase : {kSeamPhase, kInnerPhase}) {
        segments_[phase] = {&segment_begin_, items.segment(phase, 0, 0), items.colour_count[phase],
                            items.strip_count};
    }
}

void copy_rows(const Buffer<float>& table, int row_count, const std::vector<int>& elements,
               Buffer<float>& picked) {
    for (std::size_t i = 0; i < picked.count(); ++i) {
        const std::size_t column = i / elements.size() * static_cast<std::size_t>(row_count);
        picked[i] = table[column + static_cast<std::size_t>(elements[i % elements.size()])];
    }
}

}  // namespace weft
