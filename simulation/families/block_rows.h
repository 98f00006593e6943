#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "runtime/unused_memory.h"
#include "simulation/families/couplings.h"
#include "simulation/families/few_numbers.h"
#include "simulation/families/sliced_rows.h"

namespace weft {

/// Which pairs of corners contribute to blocks of the Hessian, each block one of two vertices, or
/// of two groups of them; see kernels/newton/blocks.h.
struct BlockList {
    struct Range {
        int begin = 0;
        int count = 0;
    };
    std::span<const Coupling> contributions;  ///< somebody else's, of all blocks
    std::vector<Range> ranges;                ///< [blocks] those of each
    std::vector<int> segment_begin;           ///< of the blocks, strip by strip

    int count() const { return static_cast<int>(ranges.size()); }
    std::span<const Coupling> operator[](int block) const {
        const Range& range = ranges[static_cast<std::size_t>(block)];
        return contributions.subspan(static_cast<std::size_t>(range.begin),
                                     static_cast<std::size_t>(range.count));
    }
    /// Of the rows.
    std::vector<int> lengths() const;
};

/// Per block a row of its contributions. Entries that only fill a row up name one vertex for all
/// corners, and have zeros in all tables.
class BlockRowTables {
public:
    /// name: of the buffers
    BlockRowTables(const std::string& name, const Elements& elements, const BlockList& list);

    Buffer<int>& slices() { return rows_.slices(); }
    /// [arity * entries] column-major: those of j and k first
    Buffer<int>& corners() { return corners_; }
    int entry_count() const { return rows_.entry_count(); }
    std::size_t entries() const { return static_cast<std::size_t>(rows_.entry_count()); }

    /// Gives the numbers of an entry, one per column of a table. corners: of the element, that of
    /// the block's row first, then that of its column, then the others
    using Numbers = std::function<FewNumbers(int element, const std::array<int, 4>& corners)>;
    /// table: [columns * entries] column-major
    void fill(Buffer<float>& table, const Numbers& numbers) const;
    /// All tables are: what only filling needs takes no more memory.
    void filled() { give_back(couplings_); }

private:
    void place_strip(int strip, const Elements& elements, const BlockList& list);
    void place(int block, int vertex, const Elements& elements, std::span<const Coupling> row);

    int arity_;
    SlicedRows rows_;
    Buffer<int> corners_;
    std::vector<Coupling> couplings_;  ///< [entries] element -1: fills a row up; empty: filled()
};

}  // namespace weft
