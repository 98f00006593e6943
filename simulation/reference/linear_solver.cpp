#include "simulation/reference/linear_solver.h"

#include <Eigen/SparseCholesky>
#include <algorithm>

#include "simulation/reference/coarse_level.h"
#include "simulation/reference/sparse_matrix.h"

namespace weft {

namespace {

/// So many iterations with two levels take about as long as a factorisation.
constexpr int kTwoLevelLimit = 1000;
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

}  // namespace

class LinearSolver::Preconditioner {
public:
    virtual ~Preconditioner() = default;
    virtual void apply(std::span<const Vec3> from, std::span<Vec3> to) const = 0;
};

/// The diagonal blocks for what is rough, a coarse level for what is smooth.
class LinearSolver::TwoLevels final : public Preconditioner {
public:
    explicit TwoLevels(const BlockMatrix& a)
        : inverses_(static_cast<std::size_t>(a.rows())), coarse_(a) {}

    /// False: the matrix is not positive definite.
    bool take(const BlockMatrix& a) { return take_blocks(a) && coarse_.factor(a); }

    void apply(std::span<const Vec3> from, std::span<Vec3> to) const override {
        for (std::size_t v = 0; v < to.size(); ++v) to[v] = inverses_[v] * from[v];
        coarse_.add_solution(from, to);
    }

private:
    bool take_blocks(const BlockMatrix& a) {
        for (int v = 0; v < a.rows(); ++v) {
            Mat3& inverse = inverses_[static_cast<std::size_t>(v)];
            inverse = {{Vec3{}, {}, {}}};
            const int slot = a.find(v, v);
            if (slot < 0) continue;
            const Eigen::LLT<Eigen::Matrix3d> block(
                to_eigen(a.blocks()[static_cast<std::size_t>(slot)]));
            if (block.info() != Eigen::Success) return false;
            inverse = to_mat3(block.solve(Eigen::Matrix3d::Identity()));
        }
        return true;
    }

    std::vector<Mat3> inverses_;
    CoarseLevel coarse_;
};

class LinearSolver::Factor final : public Preconditioner {
public:
    explicit Factor(const BlockMatrix& a) : solver_(lower_triangle(a)) {}
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
        if (!two_levels_) two_levels_ = std::make_unique<TwoLevels>(a);
        if (!two_levels_->take(a)) return Result::kIndefinite;
        const Result result = iterate(a, *two_levels_, b, tolerance, kTwoLevelLimit, x);
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
