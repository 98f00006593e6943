#include "kernels/energies/tetrahedron.h"

#include <gtest/gtest.h>

#include "tests/kernels/energies/differences.h"

namespace weft::test {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A tetrahedron of some shape at rest; `shape` holds b_1, b_2, b_3 as rows.
struct Rest {
    Matrix3d edges;  ///< columns: from corner 0 to the others
    Matrix3d shape;
    double mu;
    double lambda;

    Rest(const VectorXd& corners, double mu_, double lambda_) : mu(mu_), lambda(lambda_) {
        for (int k = 0; k < 3; ++k) {
            edges.col(k) = corners.segment<3>(3 * (k + 1)) - corners.head<3>();
        }
        shape = edges.inverse();
    }
    kernels::real3 b(int corner) const {
        const Eigen::RowVector3d row = corner > 0 ? Eigen::RowVector3d(shape.row(corner - 1))
                                                  : Eigen::RowVector3d(-shape.colwise().sum());
        return kernels::make3(row(0), row(1), row(2));
    }
    kernels::tetrahedron at(const VectorXd& x) const {
        return kernels::make_tetrahedron(
            kernels::tetrahedron_map(corner(x, 0), corner(x, 1), corner(x, 2), corner(x, 3), b(1),
                                     b(2), b(3)),
            mu, lambda);
    }
    /// Corners that F has moved, and then the whole by an arbitrary vector.
    VectorXd deformed(const Matrix3d& F) const {
        VectorXd x(12);
        x.head<3>() = Eigen::Vector3d(0.3, -0.2, 0.7);
        for (int k = 0; k < 3; ++k) x.segment<3>(3 * (k + 1)) = x.head<3>() + F * edges.col(k);
        return x;
    }
};

ElementEnergy element_of(const Rest& rest) {
    return {[=](const VectorXd& x) { return kernels::tetrahedron_energy(rest.at(x)); },
            [=](const VectorXd& x) {
                VectorXd gradient(12);
                for (int k = 0; k < 4; ++k) {
                    gradient.segment<3>(3 * k) =
                        to_eigen(kernels::tetrahedron_gradient(rest.at(x), rest.b(k)));
                }
                return gradient;
            },
            [=](const VectorXd& x) {
                MatrixXd hessian(12, 12);
                for (int j = 0; j < 4; ++j) {
                    for (int k = 0; k < 4; ++k) {
                        hessian.block<3, 3>(3 * j, 3 * k) =
                            to_eigen(kernels::tetrahedron_block(rest.at(x), rest.b(j), rest.b(k)));
                    }
                }
                return hessian;
            }};
}

Rest random_rest(std::mt19937& engine, double mu = 3.0, double lambda = 20.0) {
    VectorXd x = random_corners(engine, 4);
    x.segment<3>(3) += Eigen::Vector3d(3.0, 0.0, 0.0);
    x.segment<3>(6) += Eigen::Vector3d(0.0, 3.0, 0.0);
    x.segment<3>(9) += Eigen::Vector3d(0.0, 0.0, 3.0);
    return {x, mu, lambda};
}

Matrix3d random_map(std::mt19937& engine) {
    const VectorXd values = random_corners(engine, 3, 1.5);
    return Eigen::Map<const Matrix3d>(values.data());
}

/// Deformations worth a look: their names, and F.
std::vector<std::pair<const char*, Matrix3d>> special_maps() {
    const Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
    const auto stretch = [](double x, double y, double z) {
        return Matrix3d(Eigen::Vector3d(x, y, z).asDiagonal());
    };
    return {{"rest", Matrix3d::Identity()},
            {"turned", turn},
            {"inverted", turn * stretch(1, 1, -1)},
            {"turned inside out", turn * stretch(-1, -1, -1)},
            {"flat", turn * stretch(1, 1, 0)},
            {"a little inverted", turn * stretch(1.2, 0.7, -1e-3)},
            {"a line", turn * stretch(1, 0, 0)},
            {"a point", Matrix3d::Zero()},
            {"squeezed", turn * stretch(0.1, 0.1, 0.1)},
            {"long", turn * stretch(20, 0.2, 1)}};
}

TEST(Tetrahedron, DerivativesMatchDifferences) {
    std::mt19937 engine(1);
    for (int trial = 0; trial < 40; ++trial) {
        const Rest rest = random_rest(engine, 1.0, trial % 2 == 0 ? 2.0 : 500.0);
        const ElementEnergy element = element_of(rest);
        const VectorXd x = rest.deformed(random_map(engine));
        EXPECT_LT(gradient_error(element, x), 1e-8);
        EXPECT_LT(hessian_error(element, x), 1e-8);
    }
}

TEST(Tetrahedron, DerivativesMatchDifferencesWhereElementsAreInvertedOrDegenerate) {
    std::mt19937 engine(2);
    const Rest rest = random_rest(engine);
    const ElementEnergy element = element_of(rest);
    const double stiffness = element.hessian(rest.deformed(Matrix3d::Identity())).norm();
    for (const auto& [name, F] : special_maps()) {
        SCOPED_TRACE(name);
        const VectorXd x = rest.deformed(F);
        // Some have no force: so not relative to it.
        const VectorXd by_differences = gradient_by_differences(element, x);
        EXPECT_LT((by_differences - element.gradient(x)).norm(),
                  1e-8 * stiffness * F.norm() + 1e-8);
        EXPECT_LT(hessian_error(element, x), 1e-8);
    }
}

TEST(Tetrahedron, EnergyIsThatOfTheInvariants) {
    std::mt19937 engine(3);
    for (int trial = 0; trial < 40; ++trial) {
        const Rest rest = random_rest(engine);
        const Matrix3d F = random_map(engine);
        const double a = 1.0 + rest.mu / rest.lambda;
        const double at_rest = 0.5 * rest.lambda * (1.0 - a) * (1.0 - a);
        const double J = F.determinant();
        const double expected = 0.5 * rest.mu * (F.squaredNorm() - 3.0) +
                                0.5 * rest.lambda * (J - a) * (J - a) - at_rest;
        const double energy = element_of(rest).energy(rest.deformed(F));
        EXPECT_NEAR(energy, expected, 1e-12 * (1.0 + std::abs(expected)));
        EXPECT_GE(energy, 0.0);
    }
}

TEST(Tetrahedron, RestAndTurnsOfItHaveNeitherEnergyNorForce) {
    std::mt19937 engine(4);
    const Rest rest = random_rest(engine);
    const ElementEnergy element = element_of(rest);
    for (const Matrix3d& F : {special_maps()[0].second, special_maps()[1].second}) {
        const VectorXd x = rest.deformed(F);
        EXPECT_LT(std::abs(element.energy(x)), 1e-28);
        EXPECT_LT(element.gradient(x).norm(), 1e-13);
        EXPECT_GT(least_eigenvalue(element.hessian(x)), -1e-14);
    }
}

/// E = mu_L |e|^2 + lambda_L / 2 (tr e)^2 for small strains e.
TEST(Tetrahedron, SmallStrainsAreThoseOfLinearElasticity) {
    std::mt19937 engine(5);
    const double mu = 7.0;
    const double lambda_of_lame = 11.0;
    const Rest rest = random_rest(engine, mu, lambda_of_lame + mu);
    for (int trial = 0; trial < 10; ++trial) {
        const Matrix3d map = 1e-5 * random_map(engine);
        const Matrix3d strain = 0.5 * (map + map.transpose());
        const double expected =
            mu * strain.squaredNorm() + 0.5 * lambda_of_lame * strain.trace() * strain.trace();
        const VectorXd x = rest.deformed(Matrix3d::Identity() + map);
        EXPECT_NEAR(element_of(rest).energy(x), expected, 1e-4 * expected);
    }
}

TEST(Tetrahedron, VertexBlocksAreTheDiagonalAndPositive) {
    std::mt19937 engine(6);
    for (int trial = 0; trial < 200; ++trial) {
        const Rest rest = random_rest(engine, 1.0, trial % 2 == 0 ? 2.0 : 1e4);
        const Matrix3d F = trial < 10 ? special_maps()[static_cast<std::size_t>(trial)].second
                                      : Matrix3d(random_map(engine));
        const VectorXd x = rest.deformed(F);
        const MatrixXd hessian = element_of(rest).hessian(x);
        for (int k = 0; k < 4; ++k) {
            const MatrixXd block = to_eigen(kernels::tetrahedron_hessian(rest.at(x), rest.b(k)));
            EXPECT_LT(relative_difference(block, hessian.block<3, 3>(3 * k, 3 * k)), 1e-12);
            EXPECT_GT(least_eigenvalue(block), 0.0);
        }
    }
}

/// The blocks that a stencil's system is made of, for all pairs of corners.
MatrixXd coupled(const Rest& rest, const VectorXd& x) {
    MatrixXd all(12, 12);
    for (int j = 0; j < 4; ++j) {
        for (int k = 0; k < 4; ++k) {
            all.block<3, 3>(3 * j, 3 * k) =
                to_eigen(kernels::tetrahedron_coupling(rest.at(x), rest.b(j), rest.b(k)));
        }
    }
    return all;
}

TEST(Tetrahedron, CouplingIsPositiveWithTheVertexBlocksOnItsDiagonal) {
    std::mt19937 engine(8);
    for (int trial = 0; trial < 200; ++trial) {
        const Rest rest = random_rest(engine, 1.0, trial % 2 == 0 ? 2.0 : 1e4);
        const Matrix3d F = trial < 10 ? special_maps()[static_cast<std::size_t>(trial)].second
                                      : Matrix3d(random_map(engine));
        const VectorXd x = rest.deformed(F);
        const MatrixXd all = coupled(rest, x);
        EXPECT_GT(least_eigenvalue(all), -1e-14);
        for (int k = 0; k < 4; ++k) {
            const MatrixXd block = to_eigen(kernels::tetrahedron_hessian(rest.at(x), rest.b(k)));
            EXPECT_LT(relative_difference(all.block<3, 3>(3 * k, 3 * k), block), 1e-13);
        }
    }
}

TEST(Tetrahedron, CouplingIsExactWithoutPressure) {
    std::mt19937 engine(9);
    const Rest rest = random_rest(engine, 3.0, 20.0);
    // p = lambda (J - 1) - mu = 0
    const Matrix3d F = Eigen::Vector3d(1.15, 1.0, 1.0).asDiagonal();
    const VectorXd x = rest.deformed(F);
    EXPECT_LT(relative_difference(coupled(rest, x), element_of(rest).hessian(x)), 1e-12);
}

TEST(Tetrahedron, ForcesAreInternal) {
    std::mt19937 engine(7);
    for (int trial = 0; trial < 100; ++trial) {
        const Rest rest = random_rest(engine);
        const VectorXd x = rest.deformed(random_map(engine));
        EXPECT_LT(net_force(element_of(rest), x), 1e-14);
        EXPECT_LT(net_moment(element_of(rest), x), 1e-13);
        EXPECT_LT((element_of(rest).hessian(x) - element_of(rest).hessian(x).transpose()).norm(),
                  1e-12 * element_of(rest).hessian(x).norm());
    }
}

}  // namespace
}  // namespace weft::test
