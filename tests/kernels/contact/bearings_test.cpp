// How hard contacts press, as the motion of bodies says.

#include "kernels/contact/bearings.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::test {
using namespace kernels::scalar;

namespace {

constexpr real3 kUp = {0.0f, 1.0f, 0.0f}, kDown = {0.0f, -1.0f, 0.0f}, kAside = {1.0f, 0.0f, 0.0f};

/// Of a body that is borne so along y, and pressed by so much from below and from above.
bearing borne_by(float borne, float below, float above = 0.0f) {
    bearing b = no_bearing();
    b.borne.y = borne;
    b.pressed.y = below - above;
    b.press = b.spread.yy = below + above;
    return b;
}

TEST(Bearings, PressesAddUpToWhatBearsTheBody) {
    const bearing light = borne_by(2.0f, 6.0f);
    EXPECT_NEAR(correction_of(light, kUp), 1.0f / 3.0f, 1e-3f);
    const bearing heavy = borne_by(9.0f, 3.0f);
    EXPECT_NEAR(correction_of(heavy, kUp), 3.0f, 3e-3f);
}

TEST(Bearings, AreTheSameInAllUnits) {
    const auto scaled = [](float unit) { return borne_by(2.0f * unit, 6.0f * unit); };
    for (const float unit : {1e-15f, 1e15f})
        EXPECT_NEAR(correction_of(scaled(unit), kUp), correction_of(scaled(1.0f), kUp), 1e-6f);
}

TEST(Bearings, AWallThatPressesForNothingTakesNothingFromTheGround) {
    bearing cornered = borne_by(3.0f, 3.0f);
    cornered.pressed.x = cornered.spread.xx = 500.0f;
    cornered.press = 503.0f;
    EXPECT_LT(500.0f * correction_of(cornered, kAside), 1.0f);
    EXPECT_GT(correction_of(cornered, kUp), 0.9f);
}

/// As in a groove: each side presses by more than what it bears.
TEST(Bearings, PressesThatLeanAddUpToWhatBearsTheBody) {
    const float s = std::sqrt(0.5f);
    bearing grooved = no_bearing();
    grooved.borne.y = 2.0f;
    grooved.pressed.y = 10.0f * s;
    grooved.press = 10.0f;
    grooved.spread.xx = grooved.spread.yy = 5.0f;
    for (const real3 normal : {make3(s, s, 0.0f), make3(-s, s, 0.0f)})
        EXPECT_NEAR(10.0f * s * correction_of(grooved, normal), 2.0f, 0.03f);
}

TEST(Bearings, WhatIsSqueezedIsPressedAsItsContactsSay) {
    const bearing squeezed = borne_by(1.0f, 150.0f, 150.0f);
    EXPECT_FLOAT_EQ(correction_of(squeezed, kAside), 1.0f);
    EXPECT_NEAR(correction_of(squeezed, kUp), 1.0f, 1e-2f);
    EXPECT_FLOAT_EQ(correction_of(no_bearing(), kUp), 1.0f);
}

/// A sheet in a pile, of which presses say that what lies on it leads it into the ground. No
/// contact of it rubbed then.
TEST(Bearings, WhatIsPressedTheWrongWayIsCorrectedOnBothSides) {
    const bearing sheet = borne_by(1.0f, 135.0f, 165.0f);
    const float below = correction_of(sheet, kUp), above = correction_of(sheet, kDown);
    EXPECT_NEAR(135.0f * below - 165.0f * above, 1.0f, 0.1f);
    EXPECT_GT(below, 1.05f);
    EXPECT_LT(below, 1.2f);
    EXPECT_GT(above, 0.8f);
    EXPECT_LT(above, 0.95f);
    bearing untold = sheet;
    untold.spread = diagonal_sym(0.0f);
    EXPECT_LT(correction_of(untold, kUp), 0.1f) << "not known yet who tells";
}

TEST(Bearings, TheBodyThatIsPressedLessTellsForBoth) {
    bearing sheet = no_bearing();
    sheet.press = 19.0f;
    const bearing block = borne_by(3.0f, 9.0f);
    const telling of_block = tell(block, sheet, true, kUp);
    const telling of_sheet = tell(sheet, block, true, kDown);
    EXPECT_EQ(of_block.part, 1.0f);
    EXPECT_EQ(of_sheet.part, 0.0f);
    EXPECT_EQ(of_block.correction, of_sheet.correction);
    EXPECT_NEAR(of_sheet.correction, 1.0f / 3.0f, 1e-3f);
    EXPECT_EQ(tell(block, block, true, kUp).part, 0.5f);
    EXPECT_EQ(tell(sheet, no_bearing(), false, kUp).part, 1.0f);
}

}  // namespace
}  // namespace weft::test
