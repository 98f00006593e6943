#include "kernels/energies/curved_hinge.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/kernels/energies/differences.h"

namespace weft::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Weights of the corners, and p_jk = -p_kj of their pairs; rows and weights add up to 0.
struct Weights {
    std::array<double, 4> q{};
    std::array<std::array<double, 4>, 4> p{};

    /// As seen from a corner.
    kernels::curved_hinge seen_from(std::size_t own) const {
        const auto [a, b, c] = others(own);
        return {q[a], q[b], q[c], p[a][b], p[a][c], p[b][c]};
    }
    static std::array<std::size_t, 3> others(std::size_t own) {
        return {(own + 1) % 4, (own + 2) % 4, (own + 3) % 4};
    }
};

Weights complete(const VectorXd& w) {
    Weights all;
    all.q = {-w(0) - w(1) - w(2), w(0), w(1), w(2)};
    const double p12 = w(3), p13 = w(4), p23 = w(5);
    all.p = {{{0, p12 + p13, p23 - p12, -p13 - p23},
              {-p12 - p13, 0, p12, p13},
              {p12 - p23, -p12, 0, p23},
              {p13 + p23, -p13, -p23, 0}}};
    return all;
}

struct Seen {
    kernels::real3 bend, spin;
    double q;
};

Seen see(const Weights& w, const VectorXd& x, std::size_t own) {
    const auto from = [&](std::size_t k) {
        return kernels::subtract(corner(x, static_cast<int>(k)), corner(x, static_cast<int>(own)));
    };
    const auto [a, b, c] = Weights::others(own);
    const kernels::curved_hinge h = w.seen_from(own);
    return {kernels::curved_hinge_bend(h, from(a), from(b), from(c)),
            kernels::curved_hinge_spin(h, from(a), from(b), from(c)),
            kernels::curved_hinge_weight(h)};
}

ElementEnergy curved_hinge(const Weights& w) {
    return {[=](const VectorXd& x) {
                const kernels::real3 b = see(w, x, 0).bend;
                return 0.5 * kernels::dot3(b, b);
            },
            [=](const VectorXd& x) {
                VectorXd gradient(12);
                for (std::size_t k = 0; k < 4; ++k) {
                    const Seen s = see(w, x, k);
                    gradient.segment<3>(static_cast<Eigen::Index>(3 * k)) =
                        to_eigen(kernels::curved_hinge_gradient(s.bend, s.q, s.spin));
                }
                return gradient;
            },
            [=](const VectorXd& x) {
                MatrixXd hessian(12, 12);
                for (std::size_t j = 0; j < 4; ++j) {
                    for (std::size_t k = 0; k < 4; ++k) {
                        const Seen a = see(w, x, j), b = see(w, x, k);
                        hessian.block<3, 3>(static_cast<Eigen::Index>(3 * j),
                                            static_cast<Eigen::Index>(3 * k)) =
                            j == k ? to_eigen(kernels::curved_hinge_hessian(a.q, a.spin))
                                   : to_eigen(kernels::curved_hinge_coupling(
                                         a.bend, a.q, a.spin, b.q, b.spin, w.p[j][k]));
                    }
                }
                return hessian;
            }};
}

TEST(CurvedHinge, DerivativesMatchDifferences) {
    std::mt19937 engine(1);
    for (int trial = 0; trial < 20; ++trial) {
        const ElementEnergy element = curved_hinge(complete(random_corners(engine, 2, 3.0)));
        const VectorXd x = random_corners(engine, 4);
        EXPECT_LT(gradient_error(element, x), 1e-8);
        EXPECT_LT(hessian_error(element, x), 1e-8);
        EXPECT_LT(net_force(element, x), 1e-14);
        EXPECT_LT(net_moment(element, x), 1e-14);
    }
}

TEST(CurvedHinge, BlocksOfOneCornerAreDefinite) {
    std::mt19937 engine(2);
    for (int trial = 0; trial < 20; ++trial) {
        const ElementEnergy element = curved_hinge(complete(random_corners(engine, 2, 3.0)));
        const MatrixXd hessian = element.hessian(random_corners(engine, 4));
        for (int k = 0; k < 4; ++k) {
            EXPECT_GT(least_eigenvalue(hessian.block<3, 3>(3 * k, 3 * k)), -1e-14);
        }
    }
}

TEST(CurvedHinge, LooksTheSameFromEveryCorner) {
    std::mt19937 engine(3);
    const Weights w = complete(random_corners(engine, 2, 3.0));
    const VectorXd x = random_corners(engine, 4);
    for (std::size_t k = 1; k < 4; ++k) {
        EXPECT_LT((to_eigen(see(w, x, k).bend) - to_eigen(see(w, x, 0).bend)).norm(), 1e-14);
        EXPECT_NEAR(see(w, x, k).q, w.q[k], 1e-14);
    }
}

TEST(CurvedHinge, CollapsedToAPointIsFinite) {
    const VectorXd x = VectorXd::Constant(12, 0.3);
    const ElementEnergy element = curved_hinge(complete(VectorXd::Ones(6)));
    EXPECT_EQ(element.energy(x), 0.0);
    EXPECT_EQ(element.gradient(x).norm(), 0.0);
}

}  // namespace
}  // namespace weft::test
