#include "simulation/families/couplings.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "runtime/tbb/parallel.h"
#include "simulation/families/element_corners.h"

namespace weft {

namespace {

/// Fills in a vertex' row. Rows are short, and what they are sorted by fits a word: the other
/// vertex, which of the vertex' elements it is, and both corners.
void couple_vertex(const Elements& elements, std::span<const ElementCorner> corners,
                   std::span<Coupling> row) {
    static_assert(kMaxCorners <= 4);
    thread_local std::vector<std::uint64_t> keys;
    keys.clear();
    std::uint64_t first = 0;  // corner of the element here
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (corners[i].element != corners[first].element) first = i;
        for (int k = 0; k < elements.arity(); ++k) {
            if (k == corners[i].corner) continue;
            const auto other =
                static_cast<std::uint64_t>(elements.vertex_of(corners[i].element, k));
            keys.push_back(other << 32 | first << 4 | static_cast<std::uint64_t>(k) << 2 |
                           static_cast<std::uint64_t>(corners[i].corner));
        }
    }
    std::ranges::sort(keys);
    std::ranges::transform(keys, row.begin(), [&](std::uint64_t key) {
        return Coupling{corners[(key & 0xffffffff) >> 4].element,
                        static_cast<std::int16_t>(key & 3),
                        static_cast<std::int16_t>(key >> 2 & 3)};
    });
}

Grouped<Coupling> couple(const Elements& elements, int vertex_count) {
    const Grouped<ElementCorner> corners = corners_at_vertices(elements, vertex_count);
    const std::size_t others = static_cast<std::size_t>(elements.arity()) - 1;
    auto rows = Grouped<Coupling>::of_sizes(
        vertex_count, [&](int vertex) { return others * corners[vertex].size(); });
    for_each_block(vertex_count, [&](int /*block*/, int begin, int end) {
        for (int v = begin; v < end; ++v) couple_vertex(elements, corners[v], rows[v]);
    });
    return rows;
}

}  // namespace

Couplings::Couplings(const Elements& elements, int vertex_count)
    : elements_(elements), rows_(couple(elements, vertex_count)) {}

int Couplings::other_count(int vertex) const {
    int count = 0;
    for_each_other(vertex, [&](int, std::span<const Coupling>) { ++count; });
    return count;
}

}  // namespace weft
