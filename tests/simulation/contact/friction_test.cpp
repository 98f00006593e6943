// What friction does on a slope, and what slides without any. The slope is a held sheet that lies
// level, and gravity leans.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "simulation/scene/read_scene.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

constexpr double kGravity = 9.81;

/// A patch of cloth on a slope of that tangent.
Scene slope(double tangent, const std::string& friction, int frames, Method method = Method::kVbd) {
    Scene scene = parse_scene(R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 10
[solver]
method = "vbd"
iterations = 40
[contact]
thickness = 0.004
)" + friction + R"(
[[cloth]]
name = "slope"
grid = { size = [1.2, 0.4], resolution = [2, 2] }
density = 0.2
stretch = { stiffness = 20.0 }
pins = { box = [[-9, -9, -9], [9, 9, 9]] }
[[cloth]]
name = "patch"
grid = { size = [0.1, 0.1], resolution = [7, 7] }
rotate = [0, 1, 0, 13]
translate = [-0.1, 0.0034, 0.003]
density = 0.2
stretch = { stiffness = 20.0 }
)",
                              "test.toml");
    const double across = 1.0 / std::sqrt(1.0 + tangent * tangent);
    scene.gravity = {kGravity * tangent * across, -kGravity * across, 0.0};
    scene.frames = frames;
    scene.solver.method = method;
    if (method == Method::kNewton) scene.solver.iterations = 8;
    return scene;
}

Vec3 mean_of(const std::vector<float>& values, const BodyRange& body) {
    Vec3 sum;
    for (int v = 0; v < body.vertex_count; ++v) sum = sum + at(values, body.first_vertex + v);
    return (1.0 / body.vertex_count) * sum;
}

/// Where the patch is after so many frames, and how fast.
struct Patch {
    explicit Patch(const Scene& scene) : run(scene) {}
    void go(int frames) { run.run(frames); }
    Vec3 place() const { return mean_of(positions(run), run.model->bodies[1]); }
    Vec3 velocity() const { return mean_of(velocities(run), run.model->bodies[1]); }
    ManualRun run;
};

class Friction : public testing::TestWithParam<Method> {};

TEST_P(Friction, SlidesAsFastAsCoulombSays) {
    for (const auto& [tangent, coefficient] : {std::pair(0.6, 0.3), std::pair(0.35, 0.3)}) {
        Patch patch(slope(tangent, fmt::format("friction = {}\n", coefficient), 0, GetParam()));
        patch.go(6);
        const double before = patch.velocity().x;
        patch.go(18);
        const double across = 1.0 / std::sqrt(1.0 + tangent * tangent);
        const double expected = kGravity * across * (tangent - coefficient);
        EXPECT_NEAR((patch.velocity().x - before) / 0.3, expected, 0.005 * expected) << tangent;
    }
}

/// It gives way by less than the creep, once, and then rests to the rounding of places.
TEST_P(Friction, WhatSticksStays) {
    for (const double share : {0.25, 0.5, 0.8}) {
        Patch patch(slope(share * 0.5, "friction = 0.5\n", 0, GetParam()));
        patch.go(12);
        const double before = patch.place().x;
        patch.go(36);
        EXPECT_LT(std::abs(patch.place().x - before), 5e-7) << share;
        EXPECT_LT(std::abs(patch.place().z - 0.003), 1e-4);
    }
}

TEST_P(Friction, NoneLetsSlideAndNoneDriftsOnTheLevel) {
    Patch sliding(slope(0.2, "", 0, GetParam()));
    sliding.go(12);
    const double across = 1.0 / std::sqrt(1.04);
    EXPECT_NEAR(sliding.velocity().x, 0.2 * kGravity * across * 0.2, 1e-3);
    Patch resting(slope(0.0, "", 0, GetParam()));
    resting.go(60);
    EXPECT_LT(std::abs(resting.place().x + 0.1), 1e-4);
    EXPECT_LT(std::abs(resting.place().z - 0.003), 3e-4);
}

INSTANTIATE_TEST_SUITE_P(Methods, Friction, testing::Values(Method::kVbd, Method::kNewton),
                         name_of_method);

/// A patch of triangles that fit in nowhere with those below it, by more than a thickness per
/// substep in the end.
const std::string kFine = R"(
[scene]
frames = 1
dt = 0.02
substeps = 4
[solver]
iterations = 8
[contact]
thickness = 0.008
[[cloth]]
name = "slope"
grid = { size = [2.4, 0.4], resolution = [97, 17] }
density = 0.3
stretch = { stiffness = 1e4 }
pins = { box = [[-9, -9, -9], [9, 9, 9]] }
[[cloth]]
name = "patch"
grid = { size = [0.19, 0.21], resolution = [8, 11] }
rotate = [0, 1, 0, 29]
translate = [-1.0, 0.0082, 0.003]
density = 0.5
membrane = { young = 1e6, poisson = 0.3, thickness = 1e-3 }
bend = { stiffness = 1e-4 }
)";

class Slides : public EverySolver {};

/// It was braked by up to a third, and lifted.
TEST_P(Slides, OverMeshesAsOverAPlane) {
    Scene scene = scene_of(kFine);
    scene.gravity = {3.0, -9.4, 0.0};
    Patch patch(scene);
    patch.go(40);
    EXPECT_NEAR(patch.velocity().x, 3.0 * 0.8, 0.02 * 3.0 * 0.8);
    EXPECT_NEAR(patch.place().y, 0.008, 3e-4);
}

INSTANTIATE_TEST_SUITE_P(Methods, Slides, kMethods, name_of_method);

}  // namespace
}  // namespace weft::test
