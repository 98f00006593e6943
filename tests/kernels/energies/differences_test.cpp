// The language layer in double precision, and the differences themselves: they must see a wrong
// derivative.

#include <gtest/gtest.h>

#include <type_traits>

#include "tests/kernels/energies/differences.h"

namespace weft::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

static_assert(std::is_same_v<kernels::real, double>);

TEST(InDouble, ArithmeticHasDoublePrecision) {
    const kernels::real3 a = kernels::make3(1.0, 1e-10, 0.0);
    EXPECT_EQ(kernels::add(a, a).y, 2e-10);
    EXPECT_EQ(kernels::dot3(a, a), 1.0 + 1e-20);
    EXPECT_EQ(kernels::length3(kernels::make3(2.0, 0.0, 0.0)), 2.0);
    EXPECT_EQ(kernels::square_root(2.0), std::sqrt(2.0));
    EXPECT_EQ(kernels::splat(0.5f), 0.5);
}

/// E = |x|^4, whose derivatives are known; `slope` 1 gives the right gradient.
ElementEnergy quartic(double slope, double curvature) {
    return {[](const VectorXd& x) { return x.squaredNorm() * x.squaredNorm(); },
            [=](const VectorXd& x) { return VectorXd(slope * 4.0 * x.squaredNorm() * x); },
            [=](const VectorXd& x) {
                const auto n = x.size();
                return MatrixXd(curvature * (4.0 * x.squaredNorm() * MatrixXd::Identity(n, n) +
                                             8.0 * x * x.transpose()));
            }};
}

TEST(Differences, AgreeWithRightDerivativesAndSeeWrongOnes) {
    std::mt19937 engine(1);
    const VectorXd x = random_corners(engine, 2);
    EXPECT_LT(gradient_error(quartic(1.0, 1.0), x), 1e-10);
    EXPECT_LT(hessian_error(quartic(1.0, 1.0), x), 1e-10);
    EXPECT_GT(gradient_error(quartic(1.0 + 1e-6, 1.0), x), 5e-7);
    EXPECT_GT(hessian_error(quartic(1.0, 1.0 + 1e-6), x), 5e-7);
}

TEST(Differences, SeeForcesThatDoNotAddUpToZero) {
    std::mt19937 engine(2);
    const VectorXd x = random_corners(engine, 3);
    EXPECT_GT(net_force(quartic(1.0, 1.0), x), 1e-3);
    // |x|^4 pulls each corner towards the origin: no moment.
    EXPECT_LT(net_moment(quartic(1.0, 1.0), x), 1e-15);
}

TEST(Differences, ProjectToPositiveSemiDefinite) {
    const MatrixXd indefinite = Eigen::Vector3d(3.0, -1.0, 0.5).asDiagonal();
    const MatrixXd positive = Eigen::Vector3d(3.0, 0.0, 0.5).asDiagonal();
    EXPECT_LT(relative_difference(positive_part(indefinite), positive), 1e-15);
    EXPECT_NEAR(least_eigenvalue(indefinite), -1.0 / 3.0, 1e-15);
    EXPECT_EQ(least_eigenvalue(MatrixXd::Zero(3, 3)), 0.0);
}

}  // namespace
}  // namespace weft::test
