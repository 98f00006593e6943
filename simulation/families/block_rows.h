#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "simulation/families/elements.h"
#include "simulation/families/few_numbers.h"
#include "simulation/families/sliced_rows.h"
#include "simulation/topology/grouped.h"

namespace weft {

/// Which pairs of corners contribute to blocks of the Hessian, each block one of two vertices, or
/// of two groups of them; see kernels/newton/blocks.h.
struct BlockList {
    struct Contribution {
        int element = 0;
        int j = 0;  ///< corner of the block's row
        int k = 0;  ///< and of its column
    };
    Grouped<Contribution> blocks;
    std::vector<int> segment_begin;  ///< of the blocks, strip by strip

    int count() const { return blocks.count(); }
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

private:
    struct Entry {
        int element = -1;  ///< -1: fills a row up
        std::array<int, 4> corners{};
    };
    SlicedRows rows_;
    Buffer<int> corners_;
    std::vector<Entry> entries_;
};

}  // namespace weft
