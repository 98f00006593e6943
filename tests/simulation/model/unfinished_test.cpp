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

}  // namespace
}  // namespace weft::test
