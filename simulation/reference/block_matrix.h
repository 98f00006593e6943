#pragma once

#include <span>
#include <vector>

#include "simulation/mesh/vec3.h"

namespace weft {

/// A symmetric sparse matrix of 3x3 blocks, one row and column of blocks per vertex. All blocks are
/// stored, below and above the diagonal.
class BlockMatrix {
public:
    BlockMatrix() = default;
    /// coupled: which vertices have a block with each other, in groups of any size; the diagonal is
    /// always there. Vertices that are not `free` have no blocks at all.
    struct Group {
        std::span<const int> vertices;
    };
    BlockMatrix(const std::vector<char>& free, std::span<const Group> coupled);

    int rows() const { return static_cast<int>(row_begin_.size()) - 1; }
    /// Where block (row, column) is stored, or -1 where there is none.
    int find(int row, int column) const;

    void set_zero();
    void add(int slot, const Mat3& block) {
        blocks_[static_cast<std::size_t>(slot)] = blocks_[static_cast<std::size_t>(slot)] + block;
    }

    /// this = a + factor * b, of three matrices with the same blocks.
    void set_sum(const BlockMatrix& a, double factor, const BlockMatrix& b);

    /// to = this * from. Rows without blocks give 0.
    void multiply(std::span<const Vec3> from, std::span<Vec3> to) const;

    // The storage, row by row.
    std::span<const int> row_begin() const { return row_begin_; }  ///< [rows + 1]
    std::span<const int> columns() const { return columns_; }      ///< ascending in each row
    std::span<const Mat3> blocks() const { return blocks_; }

private:
    std::vector<int> row_begin_{0};
    std::vector<int> columns_;
    std::vector<Mat3> blocks_;
};

}  // namespace weft
