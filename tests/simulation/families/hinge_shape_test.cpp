#include "simulation/families/hinges/hinge_shape.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::test {
namespace {

/// Two triangles of heights 1 and 0.2 over an edge of length 2, folded by an angle, anywhere.
HingeCorners folded(double angle) {
    const Mat3 turn = rotation_matrix({1.0, 2.0, 3.0}, 40.0);
    HingeCorners x{Vec3{0, 0, 0},
                   {2, 0, 0},
                   {0.6, 1, 0},
                   {1.2, -0.2 * std::cos(angle), 0.2 * std::sin(angle)}};
    for (Vec3& corner : x) corner = turn * corner + Vec3{3, 2, 1};
    return x;
}

double energy(const std::array<double, 6>& w, const HingeCorners& x) {
    const Vec3 a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
    const Vec3 bend = w[0] * a + w[1] * b + w[2] * c + w[3] * cross(a, b) + w[4] * cross(a, c) +
                      w[5] * cross(b, c);
    return 0.5 * dot(bend, bend);
}

TEST(HingeShape, FlatOnesHaveTheWeightsOfQuadraticBending) {
    EXPECT_TRUE(half_fold(folded(0.0)).is_flat());
    EXPECT_FALSE(half_fold(folded(1e-3)).is_flat());
    const auto q = hinge_weights(folded(0.0));
    const auto w = curved_hinge_weights(folded(0.0));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(w[k], q[k + 1], 1e-13);
    for (std::size_t k = 3; k < 6; ++k) EXPECT_NEAR(w[k], 0.0, 1e-13);
}

/// E(t) = 3 L^2 / (A0 + A1) 2 sin^2((t - t0) / 2), 3/2 of the dihedral energies' limit, whatever
/// the rest fold: so neither the fold nor its sign makes it stiffer or softer.
TEST(HingeShape, EnergyDependsOnTheAngleFromRestAlone) {
    const double scale = 3.0 * 4.0 / (0.5 * 2.0 * 1.0 + 0.5 * 2.0 * 0.2);
    for (const double rest : {-3.0, -1.2, -1e-3, 0.0, 0.4, 1.5707963, 2.5, 3.1}) {
        const auto w = curved_hinge_weights(folded(rest));
        EXPECT_LT(energy(w, folded(rest)), 1e-25);
        for (double angle = -3.1; angle < 3.2; angle += 0.31) {
            const double half = std::sin(0.5 * (angle - rest));
            EXPECT_NEAR(energy(w, folded(angle)), scale * 2.0 * half * half, 1e-11)
                << "rest " << rest << ", now " << angle;
        }
    }
}

TEST(HingeShape, HalfOfTheFoldHasItsSign) {
    for (const double angle : {-3.0, -0.5, 0.2, 2.0}) {
        EXPECT_NEAR(std::abs(half_fold(folded(angle)).sine), std::abs(std::sin(0.5 * angle)),
                    1e-12);
        EXPECT_NEAR(half_fold(folded(angle)).cosine, std::cos(0.5 * angle), 1e-12);
    }
    EXPECT_LT(half_fold(folded(1.0)).sine * half_fold(folded(-1.0)).sine, 0.0);
}

}  // namespace
}  // namespace weft::test
