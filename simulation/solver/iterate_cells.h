#pragma once

#include <cstddef>
#include <vector>

#include "runtime/planning/partition.h"
#include "runtime/step.h"
#include "scheduler/exchange_map.h"
#include "simulation/solver/iterates.h"

namespace weft {

/// The parts of the iterate that a step's tasks tell apart: pieces side by side that the same
/// accesses cover are one.
class IterateCells {
public:
    struct Cell {
        std::size_t buffer;
        int first_piece;
        int end_piece;
    };

    /// The iterates must outlive this.
    IterateCells(const Iterates& iterates, const Step& step, const Partition& partition);

    const std::vector<Cell>& cells() const { return cells_; }
    /// Those that an access covers.
    scheduler::CellRange of(std::size_t buffer, const Access& access) const;

private:
    void add_buffer(std::size_t buffer, const Step& step, const Partition& partition);

    const Iterates& iterates_;
    std::vector<Cell> cells_;
};

}  // namespace weft
