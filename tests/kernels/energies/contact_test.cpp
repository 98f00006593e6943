#include "kernels/contact/energy.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace weft::test {
namespace {

constexpr double kRange = 0.003;
constexpr double kStiffness = 40.0;

double energy(double gap) { return kernels::contact_energy(gap, kRange, kStiffness); }
double slope(double gap) { return kernels::contact_slope(gap, kRange, kStiffness); }
double curvature(double gap) { return kernels::contact_curvature(gap, kRange, kStiffness); }

TEST(ContactEnergy, DerivativesMatchDifferences) {
    for (const double part : {-1.0, -0.1, 0.03, 0.07, 0.1, 0.3, 0.45, 0.55, 0.9, 0.99}) {
        const double gap = part * kRange;
        const double step = 1e-5 * kRange;
        EXPECT_NEAR((energy(gap + step) - energy(gap - step)) / (2.0 * step), slope(gap),
                    1e-7 * std::abs(slope(gap)))
            << part;
        EXPECT_NEAR((slope(gap + step) - slope(gap - step)) / (2.0 * step), curvature(gap),
                    1e-7 * curvature(gap))
            << part;
    }
}

TEST(ContactEnergy, IsSmoothWhereStagesMeet) {
    const double tau = 0.5 * kRange;
    for (const double at : {tau, tau / 8.0}) {
        const double step = 1e-14;
        EXPECT_NEAR(energy(at - step), energy(at + step), 1e-9 * energy(at));
        EXPECT_NEAR(slope(at - step), slope(at + step), -1e-6 * slope(at));
        EXPECT_NEAR(curvature(at - step), curvature(at + step), 1e-6 * curvature(at));
    }
    EXPECT_NEAR(energy(tau), 0.5 * kStiffness * tau * tau, 1e-15);
    EXPECT_NEAR(slope(tau), -kStiffness * tau, 1e-12) << "and not half of it";
    EXPECT_EQ(energy(kRange), 0.0);
    EXPECT_EQ(slope(2.0 * kRange), 0.0);
}

/// A contact of four vertices on one line: what counts of them is how far each goes along n.
TEST(ContactMajorizer, LiesAboveTheEnergy) {
    std::mt19937 engine(4);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int trial = 0; trial < 20000; ++trial) {
        const double u = 0.5 + 0.5 * any(engine);
        const double v = (1.0 - u) * (0.5 + 0.5 * any(engine));
        const std::array<double, 4> w{1.0, -u, -v, u + v - 1.0};
        const double gap = kRange * (0.1 + 0.6 * (1.0 + any(engine)));
        const double ahead = gap + kRange * any(engine);
        double end = gap;
        double bound = energy(gap);
        std::array<double, 4> moves{};
        for (double& move : moves) move = 0.3 * kRange * any(engine);
        for (int j = 0; j < 4; ++j) end += w[j] * moves[j];
        // The curvature on the way has to be known, as it is where planes end the way.
        const double c = std::max(kernels::contact_majorant(gap, ahead, kRange, kStiffness),
                                  std::max(curvature(end), curvature(gap)));
        for (int j = 0; j < 4; ++j) {
            bound += slope(gap) * w[j] * moves[j] + c * std::abs(w[j]) * moves[j] * moves[j];
        }
        EXPECT_GE(bound, energy(end) * (1.0 - 1e-12));
    }
}

TEST(ContactMajorizer, LooksAhead) {
    const double rest = kernels::contact_majorant(kRange, kRange, kRange, kStiffness);
    EXPECT_EQ(rest, kStiffness);
    EXPECT_EQ(kernels::contact_majorant(kRange, -5.0 * kRange, kRange, kStiffness),
              64.0 * kStiffness)
        << "deep, but not beyond what the look ahead trusts";
    EXPECT_EQ(kernels::contact_majorant(kRange / 12.0, kRange, kRange, kStiffness),
              curvature(kRange / 12.0));
}

}  // namespace
}  // namespace weft::test
