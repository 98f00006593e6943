#include "simulation/reference/linear_solver.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>

namespace weft {

namespace {

/// So many iterations with the diagonal blocks take about as long as a factorisation.
constexpr int kDiagonalLimit = 2000;
/// A factor of a similar matrix needs a few tens; more, and it is worth making a new one.
constexpr int kFactorLimit = 60;

double dot(std::span<const Vec3> a, std::span<const Vec3> b) {
    double sum = 0.0;
    for (std::size_t v = 0; v < a.size(); ++v) sum += weft::dot(a[v], b[v]);
    return sum;
}

/// to += s * from
void add_scaled(std::span<Vec3> to, double s, std::span<const Vec3> from) {
    for (std::size_t v = 0; v < to.size(); ++v) to[v] = to[v] + s * from[v];
}

Eigen::Matrix3d to_eigen(const Mat3& m) {
    Eigen::Matrix3d e;
    for (Eigen::Index r = 0; r < 3; ++r) {
        const Vec3& row = m.rows[static_cast<std::size_t>(r)];
        e.row(r) << row.x, row.y, row.z;
    }
    return e;
}

Mat3 to_mat3(const Eigen::Matrix3d& e) {
    Mat3 m;
    for (Eigen::Index r = 0; r < 3; ++r) {
        m.rows[static_cast<std::size_t>(r)] = {e(r, 0), e(r, 1), e(r, 2)};
    }
    return m;
}

}  // namespace

class LinearSolver::Preconditioner {
public:
    virtual ~Preconditioner() = default;
    virtual void apply(std::span<const Vec3> from, std::span<Vec3> to) const = 0;
};

class LinearSolver::DiagonalBlocks final : public Preconditioner {
public:
    explicit DiagonalBlocks(const BlockMatrix& a)
        : inverses_(static_cast<std::size_t>(a.rows()), Mat3{{Vec3{}, {}, {}}}) {
        for (int v = 0; v < a.rows(); ++v) {
            const int slot = a.find(v, v);
            if (slot < 0) continue;
            const Eigen::LLT<Eigen::Matrix3d> block(
                to_eigen(a.blocks()[static_cast<std::size_t>(slot)]));
            if (block.info() != Eigen::Success) {
                is_definite_ = false;
                return;
            }
            const Eigen::Matrix3d inverse = block.solve(Eigen::Matrix3d::Identity());
            inverses_[static_cast<std::size_t>(v)] = to_mat3(inverse);
        }
    }
    bool is_definite() const { return is_definite_; }

    void apply(std::span<const Vec3> from, std::span<Vec3> to) const override {
        for (std::size_t v = 0; v < to.size(); ++v) to[v] = inverses_[v] * from[v];
    }

private:
    std::vector<Mat3> inverses_;
    bool is_definite_ = true;
};

class LinearSolver::Factor final : public Preconditioner {
public:
    explicit Factor(const BlockMatrix& a) {
        Eigen::SparseMatrix<double> lower(3 * a.rows(), 3 * a.rows());
        std::vector<Eigen::Triplet<double>> entries;
        for (int v = 0; v < a.rows(); ++v) {
            const auto row = static_cast<std::size_t>(v);
            if (a.row_begin()[row] == a.row_begin()[row + 1]) {
                for (int k = 0; k < 3; ++k) entries.emplace_back(3 * v + k, 3 * v + k, 1.0);
            }
            for (int slot = a.row_begin()[row]; slot < a.row_begin()[row + 1]; ++slot) {
                const int column = a.columns()[static_cast<std::size_t>(slot)];
                if (column > v) break;
                const Eigen::Matrix3d block = to_eigen(a.blocks()[static_cast<std::size_t>(slot)]);
                for (int r = 0; r < 3; ++r) {
                    for (int c = 0; c < 3; ++c) {
                        if (3 * v + r >= 3 * column + c) {
                            entries.emplace_back(3 * v + r, 3 * column + c, block(r, c));
                        }
                    }
                }
            }
        }
        lower.setFromTriplets(entries.begin(), entries.end());
        solver_.compute(lower);
    }
    bool is_definite() const {
        return solver_.info() == Eigen::Success && solver_.vectorD().minCoeff() > 0.0;
    }

    void apply(std::span<const Vec3> from, std::span<Vec3> to) const override {
        // A Vec3 is three doubles, one behind the other.
        const auto size = static_cast<Eigen::Index>(3 * from.size());
        const Eigen::Map<const Eigen::VectorXd> right(&from[0].x, size);
        Eigen::Map<Eigen::VectorXd>(&to[0].x, size) = solver_.solve(right);
    }

private:
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

LinearSolver::LinearSolver() = default;
LinearSolver::~LinearSolver() = default;

LinearSolver::Result LinearSolver::solve(const BlockMatrix& a, std::span<const Vec3> b,
                                         double tolerance, std::span<Vec3> x) {
    if (!factor_) {
        const DiagonalBlocks diagonal(a);
        if (!diagonal.is_definite()) return Result::kIndefinite;
        const Result result = iterate(a, diagonal, b, tolerance, kDiagonalLimit, x);
        if (result != Result::kStuck) return result;
    } else {
        const Result result = iterate(a, *factor_, b, tolerance, kFactorLimit, x);
        if (result != Result::kStuck) return result;
    }
    auto factor = std::make_unique<Factor>(a);
    ++factorisations_;
    if (!factor->is_definite()) return Result::kIndefinite;
    factor_ = std::move(factor);
    return iterate(a, *factor_, b, tolerance, kFactorLimit, x);
}

LinearSolver::Result LinearSolver::iterate(const BlockMatrix& a,
                                           const Preconditioner& preconditioner,
                                           std::span<const Vec3> b, double tolerance, int limit,
                                           std::span<Vec3> x) {
    std::vector<Vec3> residual(b.begin(), b.end());
    std::vector<Vec3> scaled(b.size());
    std::vector<Vec3> image(b.size());
    std::fill(x.begin(), x.end(), Vec3{});
    preconditioner.apply(residual, scaled);
    std::vector<Vec3> direction = scaled;
    double size = dot(residual, scaled);
    const double enough = tolerance * tolerance * size;
    for (int i = 0; i < limit; ++i) {
        if (size <= enough) return Result::kSolved;
        a.multiply(direction, image);
        const double curvature = dot(direction, image);
        if (curvature <= 0.0) return Result::kIndefinite;
        const double step = size / curvature;
        add_scaled(x, step, direction);
        add_scaled(residual, -step, image);
        preconditioner.apply(residual, scaled);
        const double next = dot(residual, scaled);
        const double turn = next / size;
        size = next;
        for (std::size_t v = 0; v < direction.size(); ++v) {
            direction[v] = scaled[v] + turn * direction[v];
        }
        ++iterations_;
    }
    return size <= enough ? Result::kSolved : Result::kStuck;
}

}  // namespace weft
