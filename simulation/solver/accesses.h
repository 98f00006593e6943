#pragma once

#include "runtime/step.h"

namespace weft {

/// What a task reads, or reads and writes, of the rows [first, end) of a column-major table. Where
/// that is none, it is a neighbouring row: the launches have the table as an argument.
inline void add_columns(Step::Adding& task, BufferStorage& table, int rows, int columns, int first,
                        int end, bool writes) {
    if (first == end && first > 0) --first;
    if (first == end) ++end;
    for (int c = 0; c < columns; ++c) {
        if (writes)
            task.updates(table, c * rows + first, c * rows + end);
        else
            task.reads(table, c * rows + first, c * rows + end);
    }
}

}  // namespace weft
