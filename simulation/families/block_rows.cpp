#include "simulation/families/block_rows.h"

#include <algorithm>

#include "runtime/tbb/parallel.h"
#include "scheduler/assert.h"

namespace weft {

namespace {

/// The corner of the block's row, that of its column, and the others.
std::array<int, 4> corners_of(const Coupling& c, int arity) {
    std::array<int, 4> corners{c.j, c.k};
    std::size_t next = 2;
    for (int corner = 0; corner < arity; ++corner) {
        if (corner != c.j && corner != c.k) corners[next++] = corner;
    }
    return corners;
}

int row_vertex(const Elements& elements, std::span<const Coupling> row) {
    return elements.vertex_of(row.front().element, row.front().j);
}

}  // namespace

std::vector<int> BlockList::lengths() const {
    std::vector<int> lengths(ranges.size());
    std::ranges::transform(ranges, lengths.begin(), &Range::count);
    return lengths;
}

BlockRowTables::BlockRowTables(const std::string& name, const Elements& elements,
                               const BlockList& list)
    : arity_(elements.arity()),
      rows_(name + ".block_rows", list.segment_begin, list.lengths()),
      corners_(name + ".block_corners", entries() * static_cast<std::size_t>(elements.arity())),
      couplings_(entries(), Coupling{-1, 0, 0}) {
    for_each_apart(static_cast<int>(list.segment_begin.size()) - 1,
                   [&](int strip) { place_strip(strip, elements, list); });
}

void BlockRowTables::place_strip(int strip, const Elements& elements, const BlockList& list) {
    const auto begin = list.segment_begin.begin() + strip;
    int vertex = -1;  // the last block's, or else the next one's
    for (int block = begin[0]; block < begin[1]; ++block) {
        if (list[block].empty()) continue;
        vertex = row_vertex(elements, list[block]);
        break;
    }
    for (int block = begin[0]; block < begin[1]; ++block) {
        if (!list[block].empty()) vertex = row_vertex(elements, list[block]);
        place(block, vertex, elements, list[block]);
    }
}

/// vertex: for what only fills the row up
void BlockRowTables::place(int block, int vertex, const Elements& elements,
                           std::span<const Coupling> row) {
    const auto arity = static_cast<std::size_t>(elements.arity());
    const int room = rows_.room(block);
    for (int k = 0; k < room; ++k) {
        const std::size_t entry = rows_.entry(block, k);
        for (std::size_t c = 0; c < arity; ++c) corners_[c * entries() + entry] = vertex;
        if (static_cast<std::size_t>(k) >= row.size()) continue;
        const Coupling& coupling = couplings_[entry] = row[static_cast<std::size_t>(k)];
        const std::array<int, 4> corners = corners_of(coupling, arity_);
        for (std::size_t c = 0; c < arity; ++c) {
            corners_[c * entries() + entry] = elements.vertex_of(coupling.element, corners[c]);
        }
    }
}

void BlockRowTables::fill(Buffer<float>& table, const Numbers& numbers) const {
    WEFT_ASSERT(couplings_.size() == entries());
    for_each_block(entry_count(), [&](int /*block*/, int begin, int end) {
        for (auto e = static_cast<std::size_t>(begin); e < static_cast<std::size_t>(end); ++e) {
            const Coupling& coupling = couplings_[e];
            if (coupling.element < 0) continue;
            std::size_t place = e;
            for (const double number : numbers(coupling.element, corners_of(coupling, arity_))) {
                table[place] = static_cast<float>(number);
                place += entries();
            }
        }
    });
}

}  // namespace weft
