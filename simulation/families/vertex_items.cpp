#include "simulation/families/vertex_items.h"

#include <algorithm>
#include <numeric>

namespace weft {

VertexItems::VertexItems(const VertexLayout& layout)
    : vertex_count_(static_cast<int>(layout.vertices.size())),
      vertices_("items.vertices", layout.vertices.size()),
      segment_begin_("items.segments", layout.segment_begin.size()) {
    std::copy(layout.vertices.begin(), layout.vertices.end(), vertices_.data());
    std::copy(layout.segment_begin.begin(), layout.segment_begin.end(), segment_begin_.data());
    for (const Phase phase : {kSeamPhase, kInnerPhase}) {
        segments_[phase] = {&segment_begin_, layout.segment(phase, 0, 0),
                            layout.colour_count[phase], layout.strip_count};
    }
}

VertexItems::VertexItems(const Strips& strips)
    : vertex_count_(static_cast<int>(strips.order.size())),
      vertices_("items.vertices", strips.order.size()),
      segment_begin_("items.segments", strips.begin.size()) {
    std::iota(vertices_.span().begin(), vertices_.span().end(), 0);
    std::copy(strips.begin.begin(), strips.begin.end(), segment_begin_.data());
    segments_[kInnerPhase] = {&segment_begin_, 0, 1, strips.count()};
}

VertexItems::VertexItems(const Strips& strips, std::vector<int> vertices)
    : vertex_count_(static_cast<int>(strips.order.size())),
      vertices_("items.vertices", vertices.size()),
      segment_begin_("items.segments", strips.begin.size()) {
    std::ranges::sort(vertices);
    std::ranges::copy(vertices, vertices_.data());
    std::ranges::transform(strips.begin, segment_begin_.data(), [&](int begin) {
        return static_cast<int>(std::ranges::lower_bound(vertices, begin) - vertices.begin());
    });
    segments_[kInnerPhase] = {&segment_begin_, 0, 1, strips.count()};
}

}  // namespace weft
