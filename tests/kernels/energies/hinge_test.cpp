#include "kernels/energies/hinge.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/kernels/energies/differences.h"

namespace weft::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

using Weights = std::array<double, 4>;

kernels::real3 bend(const Weights& q, const VectorXd& x) {
    return kernels::hinge_bend(corner(x, 0), corner(x, 1), corner(x, 2), corner(x, 3), q[1], q[2],
                               q[3]);
}

ElementEnergy hinge(const Weights& q) {
    return {[=](const VectorXd& x) { return kernels::hinge_energy(bend(q, x)); },
            [=](const VectorXd& x) {
                VectorXd gradient(12);
                for (int k = 0; k < 4; ++k) {
                    gradient.segment<3>(3 * k) = to_eigen(
                        kernels::hinge_gradient(bend(q, x), q[static_cast<std::size_t>(k)]));
                }
                return gradient;
            },
            [=](const VectorXd&) {
                MatrixXd hessian(12, 12);
                for (int j = 0; j < 4; ++j) {
                    for (int k = 0; k < 4; ++k) {
                        const double factor = kernels::hinge_hessian(
                            q[static_cast<std::size_t>(j)], q[static_cast<std::size_t>(k)]);
                        hessian.block<3, 3>(3 * j, 3 * k) = factor * Eigen::Matrix3d::Identity();
                    }
                }
                return hessian;
            }};
}

/// A square of side 1 and its diagonal; the fourth corner is folded up by `angle` [rad].
VectorXd folded(double angle) {
    const double half = std::sqrt(0.5);
    VectorXd x(12);
    x << 0.0, -half, 0.0, 0.0, half, 0.0, -half, 0.0, 0.0, half * std::cos(angle), 0.0,
        half * std::sin(angle);
    return x;
}
/// Its weights by Bergou et al. 2006: right isosceles triangles have cotangents 1 and 0 ... so
/// K = (2, 2, -2, -2), and 3 / (A0 + A1) = 3.
const Weights kSquare = {2.0 * std::sqrt(3.0), 2.0 * std::sqrt(3.0), -2.0 * std::sqrt(3.0),
                         -2.0 * std::sqrt(3.0)};

TEST(Hinge, DerivativesMatchDifferences) {
    std::mt19937 engine(1);
    for (int trial = 0; trial < 20; ++trial) {
        const VectorXd q = random_corners(engine, 1, 5.0);
        const ElementEnergy element = hinge({-q.sum(), q(0), q(1), q(2)});
        const VectorXd x = random_corners(engine, 4);
        EXPECT_LT(gradient_error(element, x), 1e-8);
        EXPECT_LT(hessian_error(element, x), 1e-8);
        EXPECT_GT(least_eigenvalue(element.hessian(x)), -1e-14);
        EXPECT_LT(net_force(element, x), 1e-14);
        // sum x_j x q_j b = b x b
        EXPECT_LT(net_moment(element, x), 1e-14);
    }
}

TEST(Hinge, FlatHasNoEnergyWhateverTheStretchInItsPlane) {
    VectorXd x = folded(0.0);
    EXPECT_LT(hinge(kSquare).energy(x), 1e-30);
    EXPECT_LT(hinge(kSquare).gradient(x).norm(), 1e-14);
    x *= 3.0;
    EXPECT_LT(hinge(kSquare).energy(x), 1e-28);
}

/// The flat square folded by an angle t about its diagonal: b = (K, x), by hand.
TEST(Hinge, FoldedSquareHasTheEnergyOfTheClosedForm) {
    for (const double t : {0.1, 1.0, 3.0}) {
        // sum_j q_j x_j = -2 sqrt(3) / sqrt(2) (cos t - 1, 0, sin t)
        const double expected = 0.5 * 6.0 * (2.0 - 2.0 * std::cos(t));
        EXPECT_NEAR(hinge(kSquare).energy(folded(t)), expected, 1e-13);
    }
}

TEST(Hinge, CollapsedToAPointIsFinite) {
    const VectorXd x = VectorXd::Constant(12, 0.3);
    EXPECT_EQ(hinge(kSquare).energy(x), 0.0);
    EXPECT_EQ(hinge(kSquare).gradient(x).norm(), 0.0);
}

}  // namespace
}  // namespace weft::test
