// How hard contacts press, as the motion of bodies says.

#include "kernels/contact/bearings.h"

#include <gtest/gtest.h>

namespace weft::test {
using namespace kernels::scalar;

namespace {

constexpr real3 kUp = {0.0f, 1.0f, 0.0f}, kAside = {1.0f, 0.0f, 0.0f};

TEST(Bearings, PressesAddUpToWhatBearsTheBody) {
    const bearing light = {{0.0f, 2.0f, 0.0f}, {0.0f, 6.0f, 0.0f}, 6.0f};
    EXPECT_NEAR(correction_of(light, kUp), 1.0f / 3.0f, 1e-3f);
    const bearing heavy = {{0.0f, 9.0f, 0.0f}, {0.0f, 3.0f, 0.0f}, 3.0f};
    EXPECT_NEAR(correction_of(heavy, kUp), 3.0f, 3e-3f);
}

TEST(Bearings, AreTheSameInAllUnits) {
    const auto scaled = [](float unit) {
        return bearing{{0.0f, 2.0f * unit, 0.0f}, {0.0f, 6.0f * unit, 0.0f}, 6.0f * unit};
    };
    for (const float unit : {1e-15f, 1e15f})
        EXPECT_NEAR(correction_of(scaled(unit), kUp), correction_of(scaled(1.0f), kUp), 1e-6f);
}

TEST(Bearings, AWallThatPressesForNothingTakesNothingFromTheGround) {
    const bearing cornered = {{0.0f, 3.0f, 0.0f}, {500.0f, 3.0f, 0.0f}, 503.0f};
    EXPECT_LT(500.0f * correction_of(cornered, kAside), 1.0f);
    EXPECT_GT(correction_of(cornered, kUp), 0.9f);
}

TEST(Bearings, WhatIsSqueezedIsPressedAsItsContactsSay) {
    const bearing squeezed = {{0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, 300.0f};
    EXPECT_FLOAT_EQ(correction_of(squeezed, kAside), 1.0f);
    EXPECT_FLOAT_EQ(correction_of(no_bearing(), kUp), 1.0f);
}

TEST(Bearings, TheBodyThatIsPressedLessTellsForBoth) {
    const bearing sheet = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, 19.0f};
    const bearing block = {{0.0f, 3.0f, 0.0f}, {0.0f, 9.0f, 0.0f}, 9.0f};
    const telling of_block = tell(block, sheet, true, kUp);
    const telling of_sheet = tell(sheet, block, true, kUp);
    EXPECT_EQ(of_block.part, 1.0f);
    EXPECT_EQ(of_sheet.part, 0.0f);
    EXPECT_EQ(of_block.correction, of_sheet.correction);
    EXPECT_NEAR(of_sheet.correction, 1.0f / 3.0f, 1e-3f);
    EXPECT_EQ(tell(block, block, true, kUp).part, 0.5f);
    EXPECT_EQ(tell(sheet, no_bearing(), false, kUp).part, 1.0f);
}

}  // namespace
}  // namespace weft::test
