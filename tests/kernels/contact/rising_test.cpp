// What a substep starts from, of a vertex that rises off what bears it.

#include "kernels/contact/rising.h"

#include <gtest/gtest.h>

#include "runtime/row_table.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr float kStep = 0.01f;  ///< [s]
constexpr float kFall = 10.0f;  ///< gravity [m/s^2]
constexpr float kPress =
    5.0f;  ///< of the contact: its stiffness times what is missing of its range
constexpr float kHeldUp = 0.3f;  ///< what the vertex was led elsewhere than by inertia [m]

/// What is kept of that, where a held vertex bears one above it of this mass [kg] and velocity
/// [m/s].
float kept(float mass, float speed) {
    Buffer<int> begin("strips", 2);
    begin[1] = 2;
    const Segments segments{&begin, 0, 1, 1};
    Buffer<float4> positions("positions", 2);
    positions[0] = {0.0f, 0.0f, 0.0f, 0.0f};
    positions[1] = {0.0f, 0.05f, 0.0f, 1.0f / mass};
    Buffer<float4> velocities("velocities", 2);
    velocities[1] = {7.0f, speed, 0.0f, 0.0f};
    Buffer<float4> targets("targets", 2);
    targets[1] = {0.0f, kHeldUp, 0.0f, 0.0f};
    Buffer<float4> gravity("gravity", 1);
    gravity[0] = {0.0f, -kFall, 0.0f, 0.0f};
    RowTable table("contacts", segments, 2);
    auto& c0 = table.add_column<int>("corner0");
    auto& c1 = table.add_column<int>("corner1");
    auto& c2 = table.add_column<int>("corner2");
    auto& c3 = table.add_column<int>("corner3");
    auto& normals = table.add_column<float4>("normals");
    auto& weights = table.add_column<float4>("weights");
    auto& measures = table.add_column<float4>("measures");
    const auto entry = static_cast<std::size_t>(table.rows()[1]);
    table.counts()[1] = 1;
    c0[entry] = c1[entry] = c2[entry] = 1;
    normals[entry] = {0.0f, 1.0f, 0.0f, 0.05f};
    weights[entry] = {1.0f, 0.0f, 0.0f, -1.0f};
    measures[entry] = {1.0f, 1.0f, kPress / 0.05f, 0.1f};
    const Launch launched =
        launch(kernels::let_rise, Segments{}, positions, velocities, table.rows(), table.counts(),
               c0, c1, c2, c3, normals, weights, measures, targets, gravity, kStep, 0);
    run_on_host(launched, launched.kernel->scalar, 0, 2);
    return targets[1].y / kHeldUp;
}

TEST(Rising, IsNotHeldUpByItsContacts) {
    const float borne = kPress / kFall;  // the mass that the contact bears
    EXPECT_EQ(kept(borne, 0.0f), 1.0f);
    EXPECT_EQ(kept(borne, -3.0f), 1.0f) << "what falls is";
    EXPECT_NEAR(kept(borne, 0.25f * kFall * kStep), 0.75f, 1e-6f);
    EXPECT_NEAR(kept(borne, 4.0f * kFall * kStep), 0.0f, 1e-6f);
}

TEST(Rising, IsHeldUpByItsElements) {
    const float borne = kPress / kFall;
    EXPECT_NEAR(kept(4.0f * borne, kFall * kStep), 0.75f, 1e-6f) << "a quarter is borne";
    EXPECT_NEAR(kept(0.1f * borne, kFall * kStep), 0.0f, 1e-6f) << "more than all of it";
}

}  // namespace
}  // namespace weft::test
