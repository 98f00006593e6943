#include "simulation/scene/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace weft {
namespace {

void expect_near(Vec3 a, Vec3 b) { EXPECT_LT(length(a - b), 1e-12); }

TEST(Motion, ConstantVelocity) {
    const Motion motion{.velocity = {1, 2, 3}};
    EXPECT_EQ(motion.displacement(2.0).to_world({1, 1, 1}), (Vec3{3, 5, 7}));
    EXPECT_EQ(motion.displacement(2.0).axes, Mat3{});
}

TEST(Motion, TurnsRightHandedAboutItsCentre) {
    const Motion motion{.angular_velocity = 90.0, .axis = {0, 2, 0}, .center = {1, 0, 0}};
    expect_near(motion.displacement(1.0).to_world({2, 0, 0}), {1, 0, -1});
    expect_near(motion.displacement(1.0).to_world({1, 5, 0}), {1, 5, 0});
}

TEST(Motion, KeysAreLinearAndHeldOutside) {
    const Motion motion{.keys = {{1.0, {0, 0, 0}, 0.0}, {2.0, {4, 0, 0}, 180.0}}};
    EXPECT_EQ(motion.displacement(0.0), Frame{});
    EXPECT_EQ(motion.displacement(1.25).origin, (Vec3{1, 0, 0}));
    expect_near(motion.displacement(1.5).to_world({1, 0, 0}), {2, 0, -1});
    expect_near(motion.displacement(7.0).to_world({1, 0, 0}), {3, 0, 0});
}

TEST(Motion, MovesFrames) {
    const Frame rest{{1, 0, 0}, rotation_matrix({0, 0, 1}, 90)};
    EXPECT_EQ(moved(rest, std::nullopt, 3.0), rest);
    const Motion motion{.angular_velocity = 90.0, .axis = {0, 1, 0}, .center = {1, 0, 0}};
    const Frame later = moved(rest, motion, 1.0);
    expect_near(later.origin, {1, 0, 0});
    expect_near(later.to_world({0, 1, 0}), {1, 0, 1});
    expect_near(later.to_local(later.to_world({3, 4, 5})), {3, 4, 5});
}

/// A quarter about x, then one about y: on the way, the turn is about an axis of its own.
TEST(Motion, KeysMayHaveAnAxisOfTheirOwn) {
    const Motion motion{.keys = {{0.0, {}, 90.0, Vec3{1, 0, 0}}, {1.0, {}, 90.0, Vec3{0, 3, 0}}}};
    expect_near(motion.displacement(0.0).to_world({0, 1, 0}), {0, 0, 1});
    expect_near(motion.displacement(1.0).to_world({1, 0, 0}), {0, 0, -1});
    const Mat3 middle = motion.displacement(0.5).axes;
    const Vec3 axis = normalized({1, 1, 0});
    const Frame half{
        {}, rotation_matrix(axis, 2.0 * std::atan(std::sqrt(0.5)) * 180.0 / std::numbers::pi)};
    for (const Vec3 p : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
        expect_near(middle * p, half.to_world(p));
    }
    // From one to the other it is 120 degrees, at a constant rate.
    EXPECT_NEAR(fastest_turn(motion).rate, 120.0, 1e-9);
    const Mat3 early = motion.displacement(0.25).axes;
    const Mat3 step = transposed(early) * middle;
    EXPECT_NEAR(step.rows[0].x + step.rows[1].y + step.rows[2].z,
                1.0 + 2.0 * std::cos(std::numbers::pi / 6.0), 1e-12);
}

TEST(Motion, AKeyAtRestTakesTheAxisOfItsNeighbour) {
    const Motion motion{.keys = {{0.0, {}, 0.0}, {1.0, {}, 720.0, Vec3{1, 0, 0}}}};
    expect_near(motion.displacement(0.625).to_world({0, 1, 0}), {0, 0, 1});
    EXPECT_EQ(fastest_turn(motion).rate, 720.0);
}

/// A shin that hangs on a thigh.
TEST(Motion, AParentCarriesAll) {
    const auto thigh = std::make_shared<const Motion>(
        Motion{.angular_velocity = 90.0, .axis = {0, 0, 1}, .center = {0, 2, 0}});
    const Motion shin{
        .angular_velocity = -90.0, .axis = {0, 0, 1}, .center = {0, 1, 0}, .parent = thigh};
    expect_near(shin.displacement(1.0).to_world({0, 1, 0}), {1, 2, 0});  // the knee
    expect_near(shin.displacement(1.0).to_world({0, 0, 0}), {1, 1, 0});
    EXPECT_EQ(fastest_turn(shin).rate, 180.0);
}

}  // namespace
}  // namespace weft
