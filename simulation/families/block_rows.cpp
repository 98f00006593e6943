#include "simulation/families/block_rows.h"

#include <algorithm>

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
    const auto arity = static_cast<std::size_t>(elements.arity());
    for (int block = 0; block < list.count(); ++block) {
        int k = 0;
        for (const Coupling& coupling : list[block]) {
            const std::size_t place = rows_.entry(block, k++);
            couplings_[place] = coupling;
            const std::array<int, 4> corners = corners_of(coupling, arity_);
            for (std::size_t c = 0; c < arity; ++c) {
                corners_[c * entries() + place] = elements.vertex_of(coupling.element, corners[c]);
            }
        }
    }
}

void BlockRowTables::fill(Buffer<float>& table, const Numbers& numbers) const {
    WEFT_ASSERT(couplings_.size() == entries());
    for (std::size_t e = 0; e < entries(); ++e) {
        const Coupling& coupling = couplings_[e];
        if (coupling.element < 0) continue;
        std::size_t place = e;
        for (const double number : numbers(coupling.element, corners_of(coupling, arity_))) {
            table[place] = static_cast<float>(number);
            place += entries();
        }
    }
}

}  // namespace weft
