// Coulomb's law for a body as a whole.

#include "kernels/bodies/sliding.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/bodies/free_bodies.h"

namespace weft::test {
namespace {

using namespace kernels;

/// Friction 0.5; obstacles push it up by 0.02, and to the left by 0.004. A tenth of it is held, 1 m
/// below its centre; its inertia of turns is 1 m^2.
moments lying() {
    moments m = no_moments();
    m.spread = diagonal_sym(0.5f);
    m.push = make3(-0.004f, 0.02f, 0.0f);
    m.normal = make3(0.0f, 0.01f, 0.0f);
    m.depth = 0.01f;
    m.grip = 0.005f;
    m.hold.part = 0.1f;
    m.hold.place = make3(0.0f, -0.1f, 0.0f);
    m.hold.spread = outer_sym(make3(0.0f, -1.0f, 0.0f), 0.1f);
    return m;
}

const borne_lag kBorne = {{0.0f, 0.0f, 0.0f}, 0.5f};  // half of the pushes bears it

/// With half of the pushes, 0.005 is the most that friction does; 0.002 is what it does in them.
TEST(Sliding, BeginsWhereFrictionCannotKeepTheBody) {
    EXPECT_EQ(sliding_of(lying(), kBorne, make3(0.0029f, 0.0f, 0.0f)).slides, 0.0f);
    const sliding slid = sliding_of(lying(), kBorne, make3(0.004f, 0.0f, 0.0f));
    EXPECT_EQ(slid.slides, 1.0f);
    EXPECT_NEAR(slid.force.x, -0.003f, 1e-7f);
    EXPECT_EQ(slid.force.y, 0.0f);
    // What it would have to do across the surface is no friction.
    EXPECT_EQ(sliding_of(lying(), kBorne, make3(0.0029f, 0.1f, 0.0f)).slides, 0.0f);
    // It may have to push the other way.
    EXPECT_EQ(sliding_of(lying(), kBorne, make3(-0.0066f, 0.0f, 0.0f)).slides, 0.0f);
    EXPECT_NEAR(sliding_of(lying(), kBorne, make3(-0.0072f, 0.0f, 0.0f)).force.x, 0.007f, 1e-7f);
}

TEST(Sliding, IsNoMatterOfWhatIsNotHeld) {
    moments m = lying();
    m.hold = no_holding();
    const sliding s = sliding_of(m, kBorne, make3(0.1f, 0.0f, 0.0f));
    EXPECT_EQ(s.slides, 0.0f);
    EXPECT_EQ(s.force.x, 0.0f);
}

/// Two plates that grip a body push it nowhere, however much it grips.
TEST(Sliding, IsNotKnownOfWhatIsPushedFromAllSides) {
    moments m = lying();
    m.depth = 0.1f;
    EXPECT_EQ(sliding_of(m, kBorne, make3(0.1f, 0.0f, 0.0f)).slides, 0.0f);
}

/// More than that has been pushed, then.
TEST(Sliding, IsNotWhereFrictionLeadsTo) {
    const sliding s = sliding_of(lying(), kBorne, make3(0.004f, 0.0f, 0.0f));
    const auto slid_by = [&](float way) {
        return against_friction(s, make_motion(make3(way, 0.0f, 0.0f), no_motion().turn));
    };
    EXPECT_EQ(slid_by(0.001f).slides, 1.0f);
    EXPECT_EQ(slid_by(0.001f).force.x, s.force.x);
    EXPECT_EQ(slid_by(-0.001f).slides, 0.0f);
    EXPECT_EQ(slid_by(-0.001f).force.x, 0.0f);
}

TEST(Sliding, LeavesTheBodyToItsInertiaAndFriction) {
    moments m = lying();
    m.push = scale(m.push, 0.5f);
    m.lag = make3(0.01f, 0.0f, 0.0f);
    const body_step step = missing_motion(m, {m.lag, 0.0f});
    EXPECT_EQ(step.slides, 1.0f);
    // Of 0.005 at the most, the pushes have 0.002. It acts 1 m below the centre.
    EXPECT_NEAR(step.motion.shift.x, 0.01f - 0.003f, 1e-6f);
    EXPECT_NEAR(step.motion.turn.z, -0.003f, 1e-6f);
}

}  // namespace
}  // namespace weft::test
