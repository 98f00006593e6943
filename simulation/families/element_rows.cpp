#include "simulation/families/element_rows.h"

#include "runtime/tbb/parallel.h"
#include "scheduler/assert.h"

namespace weft {

namespace {

std::vector<int> lengths_of(const Grouped<ElementCorner>& corners, const VertexItems& items) {
    std::vector<int> lengths;
    for (int i = 0; i < items.count(); ++i) {
        lengths.push_back(static_cast<int>(corners[items.vertex(i)].size()));
    }
    return lengths;
}

}  // namespace

ElementRows::ElementRows(const std::string& name, const Elements& elements,
                         const VertexItems& items)
    : ElementRows(name, elements, items, corners_at_vertices(elements, items.vertex_count())) {}

ElementRows::ElementRows(const std::string& name, const Elements& elements,
                         const VertexItems& items, const Grouped<ElementCorner>& corners)
    : rows_(name + ".rows", items.segment_begin(), lengths_of(corners, items)),
      others_(name + ".others", entries() * static_cast<std::size_t>(elements.arity() - 1)),
      corners_(entries(), ElementCorner{-1, 0}) {
    for_each_block(items.count(), [&](int /*block*/, int begin, int end) {
        for (int i = begin; i < end; ++i) {
            place(i, items.vertex(i), elements, corners[items.vertex(i)]);
        }
    });
}

void ElementRows::place(int item, int vertex, const Elements& elements,
                        std::span<const ElementCorner> row) {
    const auto others = static_cast<std::size_t>(elements.arity() - 1);
    const int room = rows_.room(item);
    for (int k = 0; k < room; ++k) {
        const std::size_t entry = rows_.entry(item, k);
        for (std::size_t o = 0; o < others; ++o) others_[o * entries() + entry] = vertex;
        if (static_cast<std::size_t>(k) >= row.size()) continue;
        const ElementCorner at = corners_[entry] = row[static_cast<std::size_t>(k)];
        const auto vertices = elements.vertices_of(at.element);
        for (std::size_t o = 0; o < others; ++o) {
            const auto next = (static_cast<std::size_t>(at.corner) + 1 + o) % vertices.size();
            others_[o * entries() + entry] = vertices[next];
        }
    }
}

void ElementRows::fill(Buffer<float>& table, const Numbers& numbers) const {
    WEFT_ASSERT(corners_.size() == entries());
    for_each_block(entry_count(), [&](int /*block*/, int begin, int end) {
        for (auto e = static_cast<std::size_t>(begin); e < static_cast<std::size_t>(end); ++e) {
            const ElementCorner& at = corners_[e];
            if (at.element < 0) continue;
            std::size_t place = e;
            for (const double number : numbers(at.element, at.corner)) {
                table[place] = static_cast<float>(number);
                place += entries();
            }
        }
    });
}

}  // namespace weft
