#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "runtime/buffer.h"

namespace weft {

/// Lists laid out in WEFT_RUN_COLUMNS columns each, to be summed up on every device in one order;
/// see kernels/bodies/runs.h.
struct PartColumns {
    static constexpr int kFiller = -1;

    std::vector<int> rows;     ///< [2 * columns] first entry, number of rows
    std::vector<int> entries;  ///< which element, counted through all lists; kFiller: none
};

/// sizes: of the lists
PartColumns lay_in_columns(std::span<const std::size_t> sizes);

/// Lists of vertices as columns. A filler is the vertex before it, with no share.
/// vertices, shares  of all lists, one behind the other
/// members           [entries] written, as are
/// member_shares     [entries]
void fill_members(const PartColumns& columns, std::span<const int> vertices,
                  std::span<const double> shares, Buffer<int>& members,
                  Buffer<float>& member_shares);

}  // namespace weft
