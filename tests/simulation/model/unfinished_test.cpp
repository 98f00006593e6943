#include "simulation/model/unfinished.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::test {
namespace {

TEST(Unfinished, StrainGrowsWithTheSquareOfTheStepAndFallsWithIterations) {
    const LoadPath path{"sheet", 20.0, 0.1, 1.0, false, true};
    const double strain = unfinished_strain(path, 0.01, 4, 10.0);
    EXPECT_NEAR(strain, 0.1, 1e-12);
    EXPECT_NEAR(unfinished_strain(path, 0.005, 4, 10.0), strain / 4.0, 1e-12);
    EXPECT_NEAR(unfinished_strain(path, 0.01, 8, 10.0), strain / 2.0, 1e-12);
}

/// Half the rounding of 1 m is 6e-8 m: in a second, gravity does as much, twice over, 12,800 times.
TEST(Unfinished, MotionLeavesToRoundingWhatIsSmallerThanItself) {
    EXPECT_NEAR(substeps_of_rounding(1.0, 1.0, 9.81), std::sqrt(2.0 * 9.81 * std::exp2(24.0)), 1.0);
    EXPECT_EQ(substeps_of_rounding(1.0, 1e-6, 9.81), 1.0);
    EXPECT_GT(substeps_of_rounding(0.0, 1.0, 9.81), 1e9);
    EXPECT_GT(substeps_of_rounding(1.0, 1.0, 0.0), 1e9);
}

TEST(Unfinished, SagIsWhatSweepsLeave) {
    LoadPath path{"strip", 20.0, 0.05, 1.0, false, true};
    EXPECT_EQ(unfinished_sag(path, 0.01, 8), 0.0);
    path.softness = 0.01;
    path.firmness = 1.0e8;
    EXPECT_NEAR(unfinished_sag(path, 1e-3, 8), 1.0 / std::expm1(1.25 * 16.0 / 100.0), 1e-9);
    EXPECT_LT(unfinished_sag(path, 1e-4, 8), 1e-6);

    const double substeps = substeps_for_bending(path, 0.02, 8, 10.0);
    EXPECT_NEAR(unfinished_sag(path, 0.02 / substeps, 8), 0.15, 1e-9);
    EXPECT_NEAR(substeps_for_bending(path, 0.02, 2, 10.0), 2.0 * substeps, 1e-9);
    path.softness = 1e-5;  // Of its length it sags by 1e-4, and may by 5e-4 more.
    const double hardly = substeps_for_bending(path, 0.02, 8, 10.0);
    EXPECT_NEAR(unfinished_sag(path, 0.02 / hardly, 8), 5.0, 1e-9);
    path.softness = 1e5;
    EXPECT_EQ(substeps_for_bending(path, 0.02, 8, 10.0), 0.0) << "hangs like a rope";
}

/// Of a string of length L under a load q: s^3 = 3 q L^4 / (64 k), at rest length.
TEST(Unfinished, SpansSagByTheRootOfTheirLoad) {
    LoadPath path{.body = "sheet", .span = 2.0, .pull = 1.5, .stride = 0.05, .wave = 50.0};
    const double load = 10.0 * 1.5 * 2.0 / (8.0 * 2500.0);
    EXPECT_NEAR(sag_of_span(path, 10.0), std::cbrt(3.0 / 8.0 * load), 1e-12);
    EXPECT_NEAR(sag_of_span(path, 10.0, 0.125), 2.0 * sag_of_span(path, 10.0), 1e-12);
    path.slack = 0.2;
    EXPECT_NEAR(sag_of_span(path, 1e-9), std::sqrt(3.0 / 8.0 * 0.2), 1e-9) << "hangs in a curve";
    path.slack = -0.2;
    EXPECT_NEAR(sag_of_span(path, 1.0), 0.1 * load / 0.2, 1e-6) << "is as taut whatever its load";
}

/// A sweep does its part of what is left; where corrections are small against the material's own
/// compliance, nothing is left.
TEST(Unfinished, StiffnessOfSpansIsWhatSweepsReach) {
    const LoadPath path{.body = "sheet", .span = 1.0, .pull = 1.0, .stride = 0.05, .wave = 50.0};
    const double h = 0.05 / 50.0 / std::sqrt(2.0);  // r = 1
    EXPECT_NEAR(finished_stiffness(path, h, 1), 1.0 - std::pow(0.5, 1.5), 1e-12);
    EXPECT_NEAR(finished_stiffness(path, h, 8), 1.0 - std::pow(0.5, 12.0), 1e-12);
    EXPECT_NEAR(finished_stiffness(path, 1e3 * h, 8), 12e-6, 1e-9);
    EXPECT_EQ(finished_stiffness(path, 1e-3 * h, 8), 1.0);
}

TEST(Unfinished, SpansSagHardlyTooFarInEnoughSubsteps) {
    LoadPath path{.body = "sheet", .span = 1.0, .pull = 1.0, .stride = 0.03, .wave = 50.0};
    const auto excess = [&](double substeps) {
        const double stiffness = finished_stiffness(path, 0.02 / substeps, 8);
        return sag_of_span(path, 10.0, stiffness) - sag_of_span(path, 10.0);
    };
    for (const double slack : {0.0, 0.01, -0.001}) {
        path.slack = slack;
        EXPECT_NEAR(excess(substeps_for_span(path, 0.02, 8, 10.0)), 0.05 * sag_of_span(path, 10.0),
                    1e-9)
            << slack;
    }
    path.slack = 0.0;
    const double usual = substeps_for_span(path, 0.02, 8, 10.0);
    EXPECT_GT(substeps_for_span(path, 0.02, 2, 10.0), 2.0 * usual);
    path.wave = 2000.0;
    EXPECT_NEAR(excess(substeps_for_span(path, 0.02, 8, 10.0)), 2e-3, 1e-9) << "hardly sags";
    path.wave = 50.0;
    path.slack = 0.2;
    EXPECT_LT(substeps_for_span(path, 0.02, 8, 10.0), 0.5 * usual) << "hangs in a curve";
    path.span = 0.0;
    EXPECT_EQ(substeps_for_span(path, 0.02, 8, 10.0), 0.0);
}

}  // namespace
}  // namespace weft::test
