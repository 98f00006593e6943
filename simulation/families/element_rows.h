#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runtime/unused_memory.h"
#include "simulation/families/element_corners.h"
#include "simulation/families/family.h"
#include "simulation/families/few_numbers.h"
#include "simulation/families/sliced_rows.h"

namespace weft {

/// Per vertex a row of the elements that touch it: their other corners, in the order that follows
/// the vertex' own. Entries that only fill a row up name the vertex itself, and have zeros in all
/// tables.
class ElementRows {
public:
    /// name: of the buffers
    ElementRows(const std::string& name, const Elements& elements, const VertexItems& items);

    Buffer<int>& slices() { return rows_.slices(); }
    /// [(arity - 1) * entries] column-major
    Buffer<int>& others() { return others_; }
    int entry_count() const { return rows_.entry_count(); }
    std::size_t entries() const { return static_cast<std::size_t>(rows_.entry_count()); }

    /// Gives the numbers of an entry, one per column of a table. corner: the vertex' own
    using Numbers = std::function<FewNumbers(int element, int corner)>;
    /// table: [columns * entries] column-major
    void fill(Buffer<float>& table, const Numbers& numbers) const;
    /// All tables are: what only filling needs takes no more memory.
    void filled() { give_back(corners_); }

private:
    /// corners: at each vertex
    ElementRows(const std::string& name, const Elements& elements, const VertexItems& items,
                const Grouped<ElementCorner>& corners);
    void place(int item, int vertex, const Elements& elements, std::span<const ElementCorner> row);

    SlicedRows rows_;
    Buffer<int> others_;
    std::vector<ElementCorner> corners_;  ///< [entries] element -1: fills a row up; empty: filled()
};

}  // namespace weft
