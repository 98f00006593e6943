#include "simulation/scene/motion.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace weft
