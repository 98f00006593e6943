#include "simulation/solver/iterate_cells.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "scheduler/assert.h"

namespace weft {

IterateCells::IterateCells(const Iterates& iterates, const Step& step, const Partition& partition)
    : iterates_(iterates) {
    for (std::size_t b = 0; b < iterates.buffer_count(); ++b) add_buffer(b, step, partition);
}

scheduler::CellRange IterateCells::of(std::size_t buffer, const Access& access) const {
    const auto [first, end] = iterates_.pieces_with(access.begin, access.end);
    const auto at = [&](int piece) {
        const auto found = std::ranges::find_if(
            cells_, [&](const Cell& c) { return c.buffer == buffer && c.end_piece > piece; });
        return static_cast<int>(found - cells_.begin());
    };
    return {at(first), at(end - 1) + 1};
}

void IterateCells::add_buffer(std::size_t buffer, const Step& step, const Partition& partition) {
    std::set<int> cuts;
    for (int half = 0; half < iterates_.halves(buffer); ++half) {
        const int first = half * iterates_.pieces_per_half();
        cuts.insert(first);
        for (const Part& part : partition.parts) {
            cuts.insert(first + Iterates::kPiecesPerStrip * part.begin);
        }
        cuts.insert(first + iterates_.pieces_per_half());
    }
    for (const Task& task : step.tasks()) {
        for (const Access& access : task.accesses) {
            if (iterates_.index_of(access.buffer) != buffer) continue;
            WEFT_ASSERT(access.segments == nullptr);
            const auto [first, end] = iterates_.pieces_with(access.begin, access.end);
            cuts.insert(first);
            cuts.insert(end);
        }
    }
    for (auto cut = cuts.begin(); std::next(cut) != cuts.end(); ++cut) {
        cells_.push_back({buffer, *cut, *std::next(cut)});
    }
}

}  // namespace weft
