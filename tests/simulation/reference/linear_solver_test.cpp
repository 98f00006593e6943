#include "simulation/reference/linear_solver.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace weft {
namespace {

/// A sheet of n x n vertices with springs of stiffness 1 to the four beside them, a little inertia,
/// and one side left out (held).
BlockMatrix sheet_matrix(int n, double inertia) {
    std::vector<char> free(static_cast<std::size_t>(n * n), 1);
    for (int i = 0; i < n; ++i) free[static_cast<std::size_t>(i)] = 0;
    std::vector<std::array<int, 2>> pairs;
    for (int k = 0; k < n; ++k) {
        for (int i = 0; i < n; ++i) {
            if (i + 1 < n) pairs.push_back({k * n + i, k * n + i + 1});
            if (k + 1 < n) pairs.push_back({k * n + i, (k + 1) * n + i});
        }
    }
    std::vector<BlockMatrix::Group> groups;
    for (const auto& pair : pairs) groups.push_back({pair});
    BlockMatrix a(free, groups);
    const auto add = [&](int row, int column, double value) {
        if (const int slot = a.find(row, column); slot >= 0) a.add(slot, value * Mat3{});
    };
    for (int v = 0; v < n * n; ++v) add(v, v, inertia);
    for (const auto& [i, j] : pairs) {
        add(i, i, 1.0);
        add(j, j, 1.0);
        add(i, j, -1.0);
        add(j, i, -1.0);
    }
    return a;
}

double largest_residual(const BlockMatrix& a, const std::vector<Vec3>& b,
                        const std::vector<Vec3>& x) {
    std::vector<Vec3> image(x.size());
    a.multiply(x, image);
    double most = 0.0;
    for (std::size_t v = 0; v < b.size(); ++v) most = std::max(most, length(image[v] - b[v]));
    return most;
}

/// A pull on all that is free; it bends the whole sheet.
std::vector<Vec3> pull(int n) {
    std::vector<Vec3> b(static_cast<std::size_t>(n * n), Vec3{0.0, -1.0, 0.5});
    for (int i = 0; i < n; ++i) b[static_cast<std::size_t>(i)] = {};
    return b;
}

long iterations_for(int n) {
    const BlockMatrix a = sheet_matrix(n, 1e-6);
    const std::vector<Vec3> b = pull(n);
    std::vector<Vec3> x(b.size());
    LinearSolver solver;
    EXPECT_EQ(solver.solve(a, b, 1e-10, x), LinearSolver::Result::kSolved);
    EXPECT_EQ(solver.factorisations(), 0);
    EXPECT_LT(largest_residual(a, b, x), 1e-7 * n);
    return solver.iterations();
}

/// Diagonal blocks alone take as many times more as the sheet is wider.
TEST(LinearSolver, IterationsHardlyGrowWithTheMesh) {
    const long small = iterations_for(20);
    EXPECT_GT(small, 10);
    EXPECT_LT(iterations_for(160), 2 * small);
}

TEST(LinearSolver, TellsIndefiniteMatrices) {
    const BlockMatrix a = sheet_matrix(20, -0.5);
    const std::vector<Vec3> b = pull(20);
    std::vector<Vec3> x(b.size());
    EXPECT_EQ(LinearSolver().solve(a, b, 1e-10, x), LinearSolver::Result::kIndefinite);
}

}  // namespace
}  // namespace weft
