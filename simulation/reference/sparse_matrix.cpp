#include "simulation/reference/sparse_matrix.h"

#include <vector>

namespace weft {

namespace {

using Entries = std::vector<Eigen::Triplet<double>>;

void add_block(Entries& entries, int row, int column, const Mat3& block) {
    for (int r = 0; r < 3; ++r) {
        const Vec3& numbers = block.rows[static_cast<std::size_t>(r)];
        const double in_row[3] = {numbers.x, numbers.y, numbers.z};
        for (int c = 0; c < 3; ++c) {
            if (3 * row + r < 3 * column + c) continue;
            entries.emplace_back(3 * row + r, 3 * column + c, in_row[c]);
        }
    }
}

void add_row(Entries& entries, const BlockMatrix& a, int row) {
    const int begin = a.row_begin()[static_cast<std::size_t>(row)];
    const int end = a.row_begin()[static_cast<std::size_t>(row) + 1];
    if (begin == end) add_block(entries, row, row, Mat3{});
    for (int slot = begin; slot < end; ++slot) {
        const int column = a.columns()[static_cast<std::size_t>(slot)];
        if (column > row) break;
        add_block(entries, row, column, a.blocks()[static_cast<std::size_t>(slot)]);
    }
}

}  // namespace

Eigen::Vector3d to_eigen(const Vec3& v) { return {v.x, v.y, v.z}; }

Eigen::Matrix3d to_eigen(const Mat3& m) {
    Eigen::Matrix3d e;
    for (Eigen::Index r = 0; r < 3; ++r) e.row(r) = to_eigen(m.rows[static_cast<std::size_t>(r)]);
    return e;
}

Mat3 to_mat3(const Eigen::Matrix3d& e) {
    Mat3 m;
    for (Eigen::Index r = 0; r < 3; ++r) {
        m.rows[static_cast<std::size_t>(r)] = {e(r, 0), e(r, 1), e(r, 2)};
    }
    return m;
}

Eigen::SparseMatrix<double> lower_triangle(const BlockMatrix& a) {
    Entries entries;
    entries.reserve(5 * a.blocks().size());
    for (int row = 0; row < a.rows(); ++row) add_row(entries, a, row);
    Eigen::SparseMatrix<double> lower(3 * a.rows(), 3 * a.rows());
    lower.setFromTriplets(entries.begin(), entries.end());
    return lower;
}

}  // namespace weft
