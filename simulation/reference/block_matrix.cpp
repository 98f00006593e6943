#include "simulation/reference/block_matrix.h"

#include <algorithm>

namespace weft {

BlockMatrix::BlockMatrix(const std::vector<char>& free, std::span<const Group> coupled) {
    std::vector<std::vector<int>> columns(free.size());
    for (std::size_t v = 0; v < free.size(); ++v) {
        if (free[v]) columns[v].push_back(static_cast<int>(v));
    }
    for (const Group& group : coupled) {
        for (const int row : group.vertices) {
            if (!free[static_cast<std::size_t>(row)]) continue;
            for (const int column : group.vertices) {
                if (free[static_cast<std::size_t>(column)]) {
                    columns[static_cast<std::size_t>(row)].push_back(column);
                }
            }
        }
    }
    for (auto& row : columns) {
        std::sort(row.begin(), row.end());
        row.erase(std::unique(row.begin(), row.end()), row.end());
        columns_.insert(columns_.end(), row.begin(), row.end());
        row_begin_.push_back(static_cast<int>(columns_.size()));
    }
    blocks_.resize(columns_.size());
    set_zero();
}

int BlockMatrix::find(int row, int column) const {
    const auto begin = columns_.begin() + row_begin_[static_cast<std::size_t>(row)];
    const auto end = columns_.begin() + row_begin_[static_cast<std::size_t>(row) + 1];
    const auto at = std::lower_bound(begin, end, column);
    return at != end && *at == column ? static_cast<int>(at - columns_.begin()) : -1;
}

void BlockMatrix::set_zero() { std::fill(blocks_.begin(), blocks_.end(), Mat3{{Vec3{}, {}, {}}}); }

void BlockMatrix::set_sum(const BlockMatrix& a, double factor, const BlockMatrix& b) {
    for (std::size_t slot = 0; slot < blocks_.size(); ++slot) {
        blocks_[slot] = a.blocks_[slot] + factor * b.blocks_[slot];
    }
}

void BlockMatrix::multiply(std::span<const Vec3> from, std::span<Vec3> to) const {
    for (std::size_t row = 0; row + 1 < row_begin_.size(); ++row) {
        Vec3 sum;
        for (int slot = row_begin_[row]; slot < row_begin_[row + 1]; ++slot) {
            const auto s = static_cast<std::size_t>(slot);
            sum = sum + blocks_[s] * from[static_cast<std::size_t>(columns_[s])];
        }
        to[row] = sum;
    }
}

}  // namespace weft
