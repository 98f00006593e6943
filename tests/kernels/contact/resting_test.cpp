// Solids on convex obstacles, as rounds of bodies see them.

#include "kernels/contact/resting.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/kernels/run_on_host.h"

namespace weft::test {
namespace {

using namespace kernels;

TEST(RestingBodies, SolidsAreLedAcrossSurfacesAlone) {
    Buffer<float4> targets("targets", 2), starts("starts", 2), pressing("pressing", 2),
        seen_targets("seen_targets", 2), seen_starts("seen_starts", 2);
    Buffer<float> solid("solid", 2);
    solid[0] = 1.0f;
    for (std::size_t v = 0; v < 2; ++v) {
        starts[v] = {1.0f, 2.0f, 3.0f, 0.0f};
        targets[v] = {1.25f, 2.5f, 3.0f, 0.125f};
        pressing[v] = {0.0f, 0.01f, 0.0f, 0.0f};
    }
    const Launch launched = launch(kernels::see_targets, Segments{}, targets, starts, pressing,
                                   solid, seen_targets, seen_starts);
    run_on_host(launched, launched.kernel->scalar, 0, 2);
    EXPECT_EQ(seen_targets[0].x, 1.0f);
    EXPECT_EQ(seen_targets[0].y, 2.5f);
    EXPECT_EQ(seen_targets[0].w, 0.0f) << "nothing grips single vertices of it";
    EXPECT_EQ(seen_starts[0].y, 2.5f);
    EXPECT_EQ(seen_targets[1].x, 1.25f);
    EXPECT_EQ(seen_targets[1].w, 0.125f);
    EXPECT_EQ(seen_starts[1].y, 2.0f);
}

/// It loses what the obstacle is known to bear when it goes away, and no more.
TEST(RestingBodies, PressesNoLessThanNothing) {
    contact_entry c{};
    c.normal = make3(0.0f, 1.0f, 0.0f);
    c.stiffness = 100.0f;
    const auto pushed = [&](float gap) {
        c.gap = gap;
        return add_resting(zero_derivatives(), c, true, 5.0f);
    };
    EXPECT_EQ(pushed(0.0f).gradient.y, 0.0f);
    EXPECT_EQ(pushed(0.0f).hessian.yy, 100.0f);
    EXPECT_FLOAT_EQ(pushed(0.01f).gradient.y, 1.0f);
    EXPECT_FLOAT_EQ(pushed(-0.01f).gradient.y, -1.0f);
    EXPECT_EQ(pushed(1.0f).gradient.y, 5.0f);
    EXPECT_EQ(pushed(1.0f).hessian.yy, 0.0f);
}

/// A sphere of radius 1 that stands still, a vertex that has slid along it, and one far away.
TEST(RestingBodies, KeepsSlipsUpToTheCreep) {
    Buffer<float4> positions("positions", 2), previous("previous", 2), slips("slips", 2),
        obstacles("obstacles", WEFT_OBSTACLE_ROWS);
    for (std::size_t first : {0, 3}) {
        obstacles[first] = {1.0f, 0.0f, 0.0f, 0.0f};
        obstacles[first + 1] = {0.0f, 1.0f, 0.0f, 0.0f};
        obstacles[first + 2] = {0.0f, 0.0f, 1.0f, 0.0f};
    }
    obstacles[6] = {1.0f, 0.0f, 0.0f, 0.0f};
    obstacles[7] = {0.0f, 0.5f, 1e30f, WEFT_OBSTACLE_sphere};
    positions[0] = previous[0] = {0.0f, 1.0f, 0.0f, 1.0f};
    positions[1] = previous[1] = {0.0f, 2.0f, 0.0f, 1.0f};
    slips[0] = {1e-4f, 7.0f, 0.0f, 0.0f};
    slips[1] = {1e-4f, 0.0f, 0.0f, 0.0f};
    const auto keep = [&] {
        const Launch launched = launch(kernels::keep_resting_slips, Segments{}, positions, previous,
                                       obstacles, slips, 1, 0.1f, 1e-3f, 0);
        run_on_host(launched, launched.kernel->scalar, 0, 2);
    };
    keep();
    EXPECT_FLOAT_EQ(slips[0].x, 1e-4f);
    EXPECT_EQ(slips[0].y, 0.0f) << "that is no slip along the surface";
    EXPECT_EQ(slips[1].x, 0.0f);
    previous[0].z = -0.01f;
    keep();
    EXPECT_NEAR(std::hypot(slips[0].x, slips[0].y, slips[0].z), 1e-3f, 1e-8f);
    EXPECT_GT(slips[0].z, 0.9e-3f);
}

}  // namespace
}  // namespace weft::test
