#include "kernels/energies/membrane.h"

#include <gtest/gtest.h>

#include "tests/kernels/energies/differences.h"

namespace weft::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Matrix32 = Eigen::Matrix<double, 3, 2>;

/// A triangle of some shape at rest in a plane.
struct Rest {
    Eigen::Matrix2d edges;  ///< columns: from corner 0 to the others
    Eigen::Matrix2d shape;  ///< rows: b_1, b_2
    double mu;
    double lambda;

    Rest(std::mt19937& engine, double mu_, double lambda_) : mu(mu_), lambda(lambda_) {
        const VectorXd x = random_corners(engine, 2);
        edges << 2.0 + x(0), x(1), x(2), 2.0 + x(3);
        shape = edges.inverse();
    }
    kernels::real2 b(int corner) const {
        if (corner > 0) return kernels::make2(shape(corner - 1, 0), shape(corner - 1, 1));
        return kernels::make2(-shape(0, 0) - shape(1, 0), -shape(0, 1) - shape(1, 1));
    }
    kernels::membrane at(const VectorXd& x) const {
        return kernels::make_membrane(corner(x, 0), corner(x, 1), corner(x, 2), b(1), b(2), mu,
                                      lambda);
    }
    VectorXd deformed(const Matrix32& F) const {
        VectorXd x(9);
        x.head<3>() = Eigen::Vector3d(0.3, -0.2, 0.7);
        for (int k = 0; k < 2; ++k) x.segment<3>(3 * (k + 1)) = x.head<3>() + F * edges.col(k);
        return x;
    }
};

ElementEnergy element_of(const Rest& rest) {
    return {[=](const VectorXd& x) { return kernels::membrane_energy(rest.at(x)); },
            [=](const VectorXd& x) {
                VectorXd gradient(9);
                for (int k = 0; k < 3; ++k) {
                    gradient.segment<3>(3 * k) =
                        to_eigen(kernels::membrane_gradient(rest.at(x), rest.b(k)));
                }
                return gradient;
            },
            [=](const VectorXd& x) {
                MatrixXd hessian(9, 9);
                for (int j = 0; j < 3; ++j) {
                    for (int k = 0; k < 3; ++k) {
                        hessian.block<3, 3>(3 * j, 3 * k) =
                            to_eigen(kernels::membrane_block(rest.at(x), rest.b(j), rest.b(k)));
                    }
                }
                return hessian;
            }};
}

Matrix32 random_map(std::mt19937& engine) {
    const VectorXd values = random_corners(engine, 2, 1.5);
    return Eigen::Map<const Matrix32>(values.data());
}

/// Stretches along two axes of the plane, turned out of it.
Matrix32 stretched(double u, double v) {
    Matrix32 F;
    F << u, 0, 0, v, 0, 0;
    return Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).matrix() * F;
}

TEST(Membrane, DerivativesMatchDifferences) {
    std::mt19937 engine(1);
    for (int trial = 0; trial < 40; ++trial) {
        const Rest rest(engine, 1.0, trial % 2 == 0 ? 2.0 : 500.0);
        const ElementEnergy element = element_of(rest);
        Matrix32 F = random_map(engine);
        if (F.col(0).cross(F.col(1)).norm() < 0.2) F = stretched(1.1, 0.6);  // tested below
        const VectorXd x = rest.deformed(F);
        EXPECT_LT(gradient_error(element, x), 1e-8);
        EXPECT_LT(hessian_error(element, x), 1e-6);
    }
}

/// As an element that is nearly a line: the normal turns fast there, so the steps must be small.
TEST(Membrane, DerivativesMatchDifferencesNearlyWithoutArea) {
    std::mt19937 engine(2);
    const Rest rest(engine, 3.0, 20.0);
    for (const double thin : {0.3, 0.1, 0.05}) {
        const VectorXd x = rest.deformed(stretched(1.2, thin));
        EXPECT_LT(gradient_error(element_of(rest), x), 1e-6) << thin;
        EXPECT_LT(hessian_error(element_of(rest), x), 1e-4) << thin;
    }
}

TEST(Membrane, EnergyIsThatOfTheInvariants) {
    std::mt19937 engine(3);
    for (int trial = 0; trial < 40; ++trial) {
        const Rest rest(engine, 3.0, 20.0);
        const Matrix32 F = random_map(engine);
        const double J = F.col(0).cross(F.col(1)).norm();
        const double expected = 0.5 * rest.mu * (F.squaredNorm() - 2.0) - rest.mu * (J - 1.0) +
                                0.5 * rest.lambda * (J - 1.0) * (J - 1.0);
        EXPECT_NEAR(element_of(rest).energy(rest.deformed(F)), expected, 1e-12 * (1.0 + expected));
    }
}

/// A/A0 = 2 L^2 / ((1 - nu) + (1 + nu) L^2) where the sides are free.
TEST(Membrane, StretchedStripNarrowsByTheClosedForm) {
    std::mt19937 engine(4);
    const double nu = 0.3;
    const Rest rest(engine, 2.0, 2.0 * (1.0 + nu) / (1.0 - nu));
    for (const double L : {0.8, 1.0, 1.5, 2.0}) {
        const double ratio = 2.0 * L * L / ((1.0 - nu) + (1.0 + nu) * L * L);
        const auto energy = [&](double width) {
            return element_of(rest).energy(rest.deformed(stretched(L, width)));
        };
        const double width = ratio / L;
        const double step = 1e-4;
        EXPECT_NEAR((energy(width + step) - energy(width - step)) / (2.0 * step), 0.0, 1e-7);
        EXPECT_GT(energy(width + step), energy(width));
    }
}

/// E = mu |e|^2 + lambda_L / 2 (tr e)^2, with the lambda_L of plane stress.
TEST(Membrane, SmallStrainsAreThoseOfPlaneStress) {
    std::mt19937 engine(5);
    const double young = 10.0;
    const double nu = 0.4;
    const double mu = young / (2.0 * (1.0 + nu));
    const double lambda_of_lame = young * nu / (1.0 - nu * nu);
    const Rest rest(engine, mu, mu * (1.0 + nu) / (1.0 - nu));
    for (int trial = 0; trial < 10; ++trial) {
        const Matrix32 part = 1e-5 * random_map(engine);
        const Eigen::Matrix2d strain = 0.5 * (part.topRows<2>() + part.topRows<2>().transpose());
        const double expected =
            mu * strain.squaredNorm() + 0.5 * lambda_of_lame * strain.trace() * strain.trace();
        Matrix32 F = part;
        F.topRows<2>() += Eigen::Matrix2d::Identity();
        EXPECT_NEAR(element_of(rest).energy(rest.deformed(F)), expected, 2e-4 * expected);
    }
}

TEST(Membrane, RestAndTurnsOfItHaveNeitherEnergyNorForce) {
    std::mt19937 engine(6);
    const Rest rest(engine, 3.0, 20.0);
    const VectorXd x = rest.deformed(stretched(1.0, 1.0));
    EXPECT_LT(std::abs(element_of(rest).energy(x)), 1e-28);
    EXPECT_LT(element_of(rest).gradient(x).norm(), 1e-13);
    EXPECT_GT(least_eigenvalue(element_of(rest).hessian(x)), -1e-14);
}

TEST(Membrane, VertexBlocksAreThePositivePartOfTheDiagonal) {
    std::mt19937 engine(7);
    bool was_indefinite = false;
    for (int trial = 0; trial < 200; ++trial) {
        const Rest rest(engine, 1.0, trial % 2 == 0 ? 2.0 : 1e3);
        const VectorXd x = rest.deformed(random_map(engine));
        const MatrixXd hessian = element_of(rest).hessian(x);
        for (int k = 0; k < 3; ++k) {
            const MatrixXd exact = hessian.block<3, 3>(3 * k, 3 * k);
            const MatrixXd block = to_eigen(kernels::membrane_hessian(rest.at(x), rest.b(k)));
            EXPECT_LT(relative_difference(block, positive_part(exact)), 1e-10);
            EXPECT_GT(least_eigenvalue(block), -1e-14);
            was_indefinite = was_indefinite || least_eigenvalue(exact) < -1e-6;
        }
    }
    EXPECT_TRUE(was_indefinite) << "it is projected for a use";
}

/// The blocks that a stencil's system is made of.
MatrixXd coupled(const Rest& rest, const VectorXd& x) {
    const kernels::membrane m = rest.at(x);
    MatrixXd all(9, 9);
    for (int j = 0; j < 3; ++j) {
        for (int k = 0; k < 3; ++k) {
            all.block<3, 3>(3 * j, 3 * k) =
                j == k ? to_eigen(kernels::membrane_hessian(m, rest.b(k)))
                       : to_eigen(kernels::membrane_coupling(m, rest.b(j), rest.b(k)));
        }
    }
    return all;
}

TEST(Membrane, CouplingIsPositiveTogetherWithTheVertexBlocks) {
    std::mt19937 engine(10);
    int taut = 0;
    for (int trial = 0; trial < 400; ++trial) {
        const Rest rest(engine, 1.0, trial % 2 == 0 ? 2.0 : 1e3);
        const VectorXd x = rest.deformed(random_map(engine));
        EXPECT_GT(least_eigenvalue(coupled(rest, x)), -1e-13);
        taut += kernels::membrane_tautness(rest.at(x)) > 0.0;
    }
    EXPECT_GT(taut, 20);
    EXPECT_LT(taut, 380);
}

/// And its normal part says where it is positive.
TEST(Membrane, CouplingAlongTheNormalIsExactWhereTaut) {
    std::mt19937 engine(11);
    for (int trial = 0; trial < 100; ++trial) {
        const Rest rest(engine, 2.0, 5.0);
        const VectorXd x = rest.deformed(stretched(0.6 + 0.01 * trial, 1.3));
        const kernels::membrane m = rest.at(x);
        const Eigen::Vector3d n = to_eigen(m.normal);
        MatrixXd normal(9, 3);  // movements of each corner along n
        for (int k = 0; k < 3; ++k) {
            normal.col(k).setZero();
            normal.col(k).segment<3>(3 * k) = n;
        }
        const MatrixXd exact = normal.transpose() * element_of(rest).hessian(x) * normal;
        const bool positive = least_eigenvalue(exact) > -1e-12;
        EXPECT_EQ(positive, kernels::membrane_tautness(m) > 0.0) << trial;
        if (!positive) continue;
        const MatrixXd ours = normal.transpose() * coupled(rest, x) * normal;
        EXPECT_LT((ours - exact).norm(), 1e-12 * element_of(rest).hessian(x).norm());
    }
}

TEST(Membrane, ForcesAreInternal) {
    std::mt19937 engine(8);
    for (int trial = 0; trial < 100; ++trial) {
        const Rest rest(engine, 3.0, 20.0);
        const VectorXd x = rest.deformed(random_map(engine));
        EXPECT_LT(net_force(element_of(rest), x), 1e-13);
        EXPECT_LT(net_moment(element_of(rest), x), 1e-12);
    }
}

TEST(Membrane, WithoutAreaIsFiniteAndPulledTogether) {
    std::mt19937 engine(9);
    const Rest rest(engine, 3.0, 20.0);
    for (const double length : {1.0, 0.0}) {
        Matrix32 F = Matrix32::Zero();
        F(0, 0) = length;
        VectorXd x = rest.deformed(F);
        for (int k = 1; k < 9; k += 3) x(k) = x(k + 1) = 0.0;  // on the axis to the last bit
        const ElementEnergy element = element_of(rest);
        EXPECT_NEAR(element.energy(x), 0.5 * 3.0 * (F.squaredNorm() - 2.0) + 3.0 + 10.0, 1e-12);
        EXPECT_TRUE(element.hessian(x).allFinite());
        for (int k = 0; k < 3; ++k) {
            const kernels::real2 b = rest.b(k);
            const Eigen::Vector3d pull = 3.0 * F * Eigen::Vector2d(b.u, b.v);
            EXPECT_LT((element.gradient(x).segment<3>(3 * k) - pull).norm(), 1e-12);
            EXPECT_GT(least_eigenvalue(to_eigen(kernels::membrane_hessian(rest.at(x), b))), -1e-14);
        }
    }
}

}  // namespace
}  // namespace weft::test
