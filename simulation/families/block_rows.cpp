#include "simulation/families/block_rows.h"

#include <algorithm>

namespace weft {

namespace {

std::array<int, 4> from(const BlockList::Contribution& c, int arity) {
    std::array<int, 4> corners{c.j, c.k};
    std::size_t next = 2;
    for (int corner = 0; corner < arity; ++corner) {
        if (corner != c.j && corner != c.k) corners[next++] = corner;
    }
    return corners;
}

}  // namespace

std::vector<int> BlockList::lengths() const {
    std::vector<int> lengths;
    for (int block = 0; block < count(); ++block) {
        lengths.push_back(static_cast<int>(blocks[block].size()));
    }
    return lengths;
}

BlockRowTables::BlockRowTables(const std::string& name, const Elements& elements,
                               const BlockList& list)
    : rows_(name + ".block_rows", list.segment_begin, list.lengths()),
      corners_(name + ".block_corners", entries() * static_cast<std::size_t>(elements.arity())),
      entries_(entries()) {
    const auto arity = static_cast<std::size_t>(elements.arity());
    for (int block = 0; block < list.count(); ++block) {
        const auto row = list.blocks[block];
        for (std::size_t e = 0; e < row.size(); ++e) {
            const std::size_t place = rows_.entry(block, static_cast<int>(e));
            const Entry& entry = entries_[place] = {row[e].element, from(row[e], elements.arity())};
            const auto vertices = elements.vertices_of(entry.element);
            for (std::size_t c = 0; c < arity; ++c) {
                corners_[c * entries() + place] =
                    vertices[static_cast<std::size_t>(entry.corners[c])];
            }
        }
    }
}

void BlockRowTables::fill(Buffer<float>& table, const Numbers& numbers) const {
    for (std::size_t e = 0; e < entries(); ++e) {
        const Entry& entry = entries_[e];
        if (entry.element < 0) continue;
        std::size_t place = e;
        for (const double number : numbers(entry.element, entry.corners)) {
            table[place] = static_cast<float>(number);
            place += entries();
        }
    }
}

}  // namespace weft
