#pragma once

#include <memory>
#include <span>
#include <vector>

#include "simulation/reference/block_matrix.h"

namespace weft {

/// Solves A x = b for sparse symmetric A by conjugate gradients: preconditioned by A's diagonal
/// blocks and a coarse level, and where these do not serve by a sparse factorisation, which then
/// serves for the similar matrices of later calls, too. All calls: matrices with the same blocks.
class LinearSolver {
public:
    LinearSolver();
    ~LinearSolver();
    LinearSolver(const LinearSolver&) = delete;
    LinearSolver& operator=(const LinearSolver&) = delete;

    enum class Result {
        kSolved,
        kIndefinite,  ///< a direction of negative curvature was met: A is not positive definite
        kStuck,       ///< the residual did not get there; `x` is still a descent direction
    };
    /// x: written, unless the result is kIndefinite. The residual's size gets below tolerance
    /// times that of b, in the norm of the preconditioner.
    Result solve(const BlockMatrix& a, std::span<const Vec3> b, double tolerance,
                 std::span<Vec3> x);

    long iterations() const { return iterations_; }  ///< of all calls
    int factorisations() const { return factorisations_; }

private:
    class Preconditioner;
    class TwoLevels;
    class Factor;
    Result iterate(const BlockMatrix& a, const Preconditioner& preconditioner,
                   std::span<const Vec3> b, double tolerance, int limit, std::span<Vec3> x);

    std::unique_ptr<TwoLevels> two_levels_;
    std::unique_ptr<Factor> factor_;
    long iterations_ = 0;
    int factorisations_ = 0;
};

}  // namespace weft
