#pragma once

#include <Eigen/SparseCholesky>
#include <span>
#include <vector>

#include "simulation/reference/block_matrix.h"

namespace weft {

/// The smooth part of a matrix, to be solved for directly: one translation per aggregate, a few
/// vertices that hang together. What diagonal blocks are slow at (waves much longer than an edge)
/// is what this gets right: the two together are a preconditioner whose worth hardly depends on the
/// mesh's size. Plain aggregation; see Vanek, Mandel and Brezina 1996 for more.
class CoarseLevel {
public:
    /// Chooses aggregates by which rows are coupled; the values of `a` do not count.
    explicit CoarseLevel(const BlockMatrix& a);

    /// Takes the values of a matrix with the same blocks. False: it is not positive definite.
    bool factor(const BlockMatrix& a);
    /// to += P (P^T A P)^-1 P^T from, P spreading each aggregate's translation over its vertices.
    void add_solution(std::span<const Vec3> from, std::span<Vec3> to) const;

private:
    void grow_aggregates(const BlockMatrix& a);
    void make_pattern(const BlockMatrix& a);

    int count_ = 0;
    std::vector<int> aggregate_;  ///< [rows of the matrix], -1 where it has no blocks
    BlockMatrix coarse_;
    std::vector<int> slots_;  ///< [blocks of the matrix] in coarse_
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
    bool is_analysed_ = false;
};

}  // namespace weft
