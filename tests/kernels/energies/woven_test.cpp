#include "kernels/energies/woven.h"

#include <gtest/gtest.h>

#include "tests/kernels/energies/differences.h"

namespace weft::test {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using Matrix32 = Eigen::Matrix<double, 3, 2>;

/// A triangle of some shape at rest in a plane, the warp along its first axis.
struct Rest {
    Eigen::Matrix2d edges;  ///< columns: from corner 0 to the others
    Eigen::Matrix2d shape;  ///< rows: b_1, b_2
    double warp;
    double weft;
    double shear;

    Rest(std::mt19937& engine, double warp_, double weft_, double shear_)
        : warp(warp_), weft(weft_), shear(shear_) {
        const VectorXd x = random_corners(engine, 2);
        edges << 2.0 + x(0), x(1), x(2), 2.0 + x(3);
        shape = edges.inverse();
    }
    kernels::real2 b(int corner) const {
        if (corner > 0) return kernels::make2(shape(corner - 1, 0), shape(corner - 1, 1));
        return kernels::make2(-shape(0, 0) - shape(1, 0), -shape(0, 1) - shape(1, 1));
    }
    kernels::woven at(const VectorXd& x) const {
        return kernels::make_woven(corner(x, 0), corner(x, 1), corner(x, 2), b(1), b(2), warp, weft,
                                   shear);
    }
    VectorXd deformed(const Matrix32& F) const {
        VectorXd x(9);
        x.head<3>() = Eigen::Vector3d(0.3, -0.2, 0.7);
        for (int k = 0; k < 2; ++k) x.segment<3>(3 * (k + 1)) = x.head<3>() + F * edges.col(k);
        return x;
    }
};

/// All blocks of `block(w, b_j, b_k)`.
template <class Block>
MatrixXd assembled(const Rest& rest, const VectorXd& x, Block block) {
    MatrixXd all(9, 9);
    for (int j = 0; j < 3; ++j) {
        for (int k = 0; k < 3; ++k) {
            all.block<3, 3>(3 * j, 3 * k) = to_eigen(block(rest.at(x), rest.b(j), rest.b(k)));
        }
    }
    return all;
}

ElementEnergy element_of(const Rest& rest) {
    return {[=](const VectorXd& x) { return kernels::woven_energy(rest.at(x)); },
            [=](const VectorXd& x) {
                VectorXd gradient(9);
                for (int k = 0; k < 3; ++k) {
                    gradient.segment<3>(3 * k) =
                        to_eigen(kernels::woven_gradient(rest.at(x), rest.b(k)));
                }
                return gradient;
            },
            [=](const VectorXd& x) { return assembled(rest, x, kernels::woven_block); }};
}

Matrix32 random_map(std::mt19937& engine) {
    const VectorXd values = random_corners(engine, 2, 1.5);
    return Eigen::Map<const Matrix32>(values.data());
}

/// A map of the plane, turned out of it.
Matrix32 turned(const Eigen::Matrix2d& map) {
    Matrix32 F = Matrix32::Zero();
    F.topRows<2>() = map;
    return Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).matrix() * F;
}

TEST(Woven, DerivativesMatchDifferences) {
    std::mt19937 engine(1);
    int trials = 0;
    while (trials < 40) {
        const Rest rest(engine, 3.0, trials % 2 == 0 ? 2.0 : 500.0, 0.7);
        const Matrix32 F = random_map(engine);
        // Near a thread without length the energy is not smooth.
        if (F.col(0).norm() < 0.3 || F.col(1).norm() < 0.3) continue;
        const VectorXd x = rest.deformed(F);
        EXPECT_LT(gradient_error(element_of(rest), x), 1e-8);
        EXPECT_LT(hessian_error(element_of(rest), x), 1e-6);
        ++trials;
    }
}

TEST(Woven, EnergyIsThatOfTheThreads) {
    std::mt19937 engine(2);
    for (int trial = 0; trial < 40; ++trial) {
        const Rest rest(engine, 3.0, 20.0, 5.0);
        const Matrix32 F = random_map(engine);
        const double warp = F.col(0).norm() - 1.0;
        const double weft = F.col(1).norm() - 1.0;
        const double shear = F.col(0).dot(F.col(1));
        const double expected =
            0.5 * (3.0 * warp * warp + 20.0 * weft * weft + 5.0 * shear * shear);
        EXPECT_NEAR(element_of(rest).energy(rest.deformed(F)), expected, 1e-12 * (1.0 + expected));
    }
}

TEST(Woven, RestAndTurnsOfItHaveNeitherEnergyNorForce) {
    std::mt19937 engine(3);
    const Rest rest(engine, 3.0, 20.0, 5.0);
    const VectorXd x = rest.deformed(turned(Eigen::Matrix2d::Identity()));
    EXPECT_LT(element_of(rest).energy(x), 1e-28);
    EXPECT_LT(element_of(rest).gradient(x).norm(), 1e-13);
    EXPECT_GT(least_eigenvalue(element_of(rest).hessian(x)), -1e-14);
}

/// A small turn of one thread against the other is an angle of shear.
TEST(Woven, SmallShearHasTheShearModulus) {
    std::mt19937 engine(4);
    const Rest rest(engine, 3.0, 20.0, 5.0);
    const double angle = 1e-4;
    Eigen::Matrix2d map = Eigen::Matrix2d::Identity();
    map.col(1) << std::sin(angle), std::cos(angle);
    EXPECT_NEAR(element_of(rest).energy(rest.deformed(turned(map))), 0.5 * 5.0 * angle * angle,
                1e-7 * angle * angle);
}

/// Along the bias, between equal threads: the closed form in woven.h is where no force is left
/// across, and its pull is the energy's derivative along.
TEST(Woven, BiasPullFollowsTheClosedForm) {
    std::mt19937 engine(5);
    const double k = 30.0;
    const double shear = 4.0;
    const Rest rest(engine, k, k, shear);
    const double c = std::sqrt(0.5);
    const Eigen::Matrix2d axes = (Eigen::Matrix2d() << c, -c, c, c).finished();
    const auto energy = [&](double a, double b) {
        const Eigen::Matrix2d map = axes * Vector2d(a, b).asDiagonal() * axes.transpose();
        return element_of(rest).energy(rest.deformed(turned(map)));
    };
    for (const double q : {-0.5, 0.1, 1.0, 3.0}) {
        const double s = 1.0 / (1.0 - q / k);
        const double a = std::sqrt(s * s + q / shear);
        const double b = std::sqrt(s * s - q / shear);
        const double step = 1e-5;
        EXPECT_NEAR((energy(a, b + step) - energy(a, b - step)) / (2.0 * step), 0.0, 1e-7) << q;
        EXPECT_NEAR((energy(a + step, b) - energy(a - step, b)) / (2.0 * step), 2.0 * a * q, 1e-7)
            << q;
    }
}

MatrixXd projected(const Rest& rest, const VectorXd& x) {
    return assembled(rest, x, kernels::woven_coupling);
}

TEST(Woven, ProjectedBlocksArePositiveAndNoLessStiffThanTheExactOnes) {
    std::mt19937 engine(6);
    bool was_indefinite = false;
    for (int trial = 0; trial < 400; ++trial) {
        const Rest rest(engine, 1.0, trial % 2 == 0 ? 2.0 : 1e3, trial % 3 == 0 ? 10.0 : 0.1);
        const VectorXd x = rest.deformed(random_map(engine));
        const MatrixXd exact = element_of(rest).hessian(x);
        const MatrixXd ours = projected(rest, x);
        EXPECT_GT(least_eigenvalue(ours), -1e-13);
        const Eigen::SelfAdjointEigenSolver<MatrixXd> difference(ours - exact);
        EXPECT_GT(difference.eigenvalues()(0), -1e-12 * exact.norm());
        was_indefinite = was_indefinite || least_eigenvalue(exact) < -1e-6;
    }
    EXPECT_TRUE(was_indefinite) << "it is projected for a use";
}

TEST(Woven, ProjectedBlocksAreExactUnderTensionWithoutShear) {
    std::mt19937 engine(7);
    const Rest rest(engine, 3.0, 20.0, 5.0);
    const VectorXd x = rest.deformed(turned(Vector2d(1.2, 1.5).asDiagonal()));
    EXPECT_LT(relative_difference(projected(rest, x), element_of(rest).hessian(x)), 1e-12);
}

TEST(Woven, VertexBlocksAreTheDiagonalOfTheProjectedOnes) {
    std::mt19937 engine(8);
    for (int trial = 0; trial < 100; ++trial) {
        const Rest rest(engine, 3.0, 20.0, 5.0);
        const VectorXd x = rest.deformed(random_map(engine));
        const MatrixXd all = projected(rest, x);
        for (int k = 0; k < 3; ++k) {
            const MatrixXd block = to_eigen(kernels::woven_hessian(rest.at(x), rest.b(k)));
            EXPECT_LT(relative_difference(block, all.block<3, 3>(3 * k, 3 * k)), 1e-13);
        }
    }
}

TEST(Woven, ForcesAreInternal) {
    std::mt19937 engine(9);
    for (int trial = 0; trial < 100; ++trial) {
        const Rest rest(engine, 3.0, 20.0, 5.0);
        const VectorXd x = rest.deformed(random_map(engine));
        EXPECT_LT(net_force(element_of(rest), x), 1e-13);
        EXPECT_LT(net_moment(element_of(rest), x), 1e-12);
    }
}

TEST(Woven, ThreadsWithoutLengthAreFinite) {
    std::mt19937 engine(10);
    const Rest rest(engine, 3.0, 20.0, 5.0);
    const VectorXd x = VectorXd::Zero(9);
    EXPECT_NEAR(element_of(rest).energy(x), 0.5 * (3.0 + 20.0), 1e-12);
    EXPECT_EQ(element_of(rest).gradient(x).norm(), 0.0);
    EXPECT_EQ(projected(rest, x).norm(), 0.0);
}

}  // namespace
}  // namespace weft::test
