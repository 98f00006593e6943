#include "kernels/energies/spring.h"

#include <gtest/gtest.h>

#include "tests/kernels/energies/differences.h"

namespace weft::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

ElementEnergy spring(double rest, double k) {
    return {[=](const VectorXd& x) {
                return kernels::spring_energy(corner(x, 0), corner(x, 1), rest, k);
            },
            [=](const VectorXd& x) {
                const auto pull =
                    to_eigen(kernels::spring_gradient(corner(x, 0), corner(x, 1), rest, k));
                VectorXd gradient(6);
                gradient << pull, -pull;
                return gradient;
            },
            [=](const VectorXd& x) {
                const MatrixXd block =
                    to_eigen(kernels::spring_hessian(corner(x, 0), corner(x, 1), rest, k));
                MatrixXd hessian(6, 6);
                hessian << block, -block, -block, block;
                return hessian;
            }};
}

double length(const VectorXd& x) { return (x.tail<3>() - x.head<3>()).norm(); }

TEST(Spring, DerivativesMatchDifferences) {
    std::mt19937 engine(1);
    for (const double k : {1e-6, 1.0, 1e8}) {
        for (const double strain : {-0.9, -0.1, 1e-3, 0.5, 20.0}) {
            const VectorXd x = random_corners(engine, 2);
            const ElementEnergy element = spring(length(x) / (1.0 + strain), k);
            EXPECT_LT(gradient_error(element, x), 1e-8) << "strain " << strain;
            const MatrixXd exact = hessian_by_differences(element, x);
            EXPECT_LT(relative_difference(positive_part(exact), element.hessian(x)), 1e-8)
                << "strain " << strain;
            EXPECT_EQ(strain < 0.0, least_eigenvalue(exact) < -1e-6) << "it is projected for a use";
        }
    }
}

TEST(Spring, HessianIsPositiveAndForcesAreInternal) {
    std::mt19937 engine(2);
    for (int trial = 0; trial < 200; ++trial) {
        const VectorXd x = random_corners(engine, 2);
        const ElementEnergy element = spring(0.01 * trial, 10.0);
        EXPECT_GT(least_eigenvalue(element.hessian(x)), -1e-14);
        EXPECT_LT(net_force(element, x), 1e-15);
        EXPECT_LT(net_moment(element, x), 1e-14);
    }
}

TEST(Spring, AtRestHasNeitherEnergyNorForce) {
    VectorXd x(6);
    x << 1.0, 2.0, 3.0, 1.0, 2.0, 5.0;
    const ElementEnergy element = spring(2.0, 100.0);
    EXPECT_EQ(element.energy(x), 0.0);
    EXPECT_EQ(element.gradient(x).norm(), 0.0);
    const Eigen::Vector3d along(0.0, 0.0, 100.0);
    EXPECT_EQ(MatrixXd(element.hessian(x).topLeftCorner(3, 3)), MatrixXd(along.asDiagonal()));
}

TEST(Spring, OfZeroLengthIsFiniteAndHasNoForce) {
    VectorXd x(6);
    x << 1.0, 2.0, 3.0, 1.0, 2.0, 3.0;
    const ElementEnergy element = spring(0.5, 8.0);
    EXPECT_EQ(element.energy(x), 1.0);
    EXPECT_EQ(element.gradient(x).norm(), 0.0);
    EXPECT_TRUE(element.hessian(x).allFinite());
    EXPECT_GE(least_eigenvalue(element.hessian(x)), 0.0);

    // A rest length of zero is a linear spring: k (x0 - x1), even there.
    const ElementEnergy linear = spring(0.0, 8.0);
    x(3) += 1e-12;
    EXPECT_LT(
        relative_difference(linear.hessian(x).topLeftCorner(3, 3), 8.0 * MatrixXd::Identity(3, 3)),
        1e-12);
}

}  // namespace
}  // namespace weft::test
