#pragma once

#include <array>

#include "simulation/families/family.h"

namespace weft {

/// The stencils of one family in one sweep: which items their corners are, and where they lie.
class StencilTables {
public:
    StencilTables(const VertexLayout& items, const StencilLayout::Family& chosen);

    /// `tables` are those of the family's elements, if it has any; see kernels/sosd/stencil.h.
    template <class Kernel, class... Tables>
    Launch launch_over(Kernel kernel, const SweepTarget& t, Tables&... tables) {
        return launch(kernel, segments_[t.phase], t.positions, t.targets, t.items.vertices(),
                      corners_, tables..., t.sums, count_, t.items.count(), t.inverse_h2);
    }

private:
    Buffer<int> corners_;  ///< [arity * count] column-major: items
    Buffer<int> segment_begin_;
    std::array<Segments, kPhaseCount> segments_;
    int count_;
};

/// The rows of a column-major table that belong to these elements.
void copy_rows(const Buffer<float>& table, int row_count, const std::vector<int>& elements,
               Buffer<float>& picked);

}  // namespace weft
