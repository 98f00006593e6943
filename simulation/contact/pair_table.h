#pragma once

#include <string>

#include "runtime/row_table.h"
#include "runtime/step.h"

namespace weft {

/// Rows of numbers of others, ascending, which kernels fill.
struct PairTable {
    PairTable(const std::string& name, const Segments& items, int room)
        : table(name, items, room), others(table.add_column<int>("others")) {}

    /// Of a task that fills the rows of items [first, last).
    void add_fills(Step::Adding& task, int first, int last) {
        task.updates(table.counts(), first, last)
            .updates(table.needs(), first, last)
            .updates(others, table.entries());
    }

    RowTable table;
    Buffer<int>& others;
};

}  // namespace weft
