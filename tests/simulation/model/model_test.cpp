#include "simulation/model/model.h"
#include "simulation/families/hinges/hinges.h"
#include "simulation/families/springs/springs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulation/families/convert.h"
#include "simulation/families/hinges/hinge_shape.h"
#include "simulation/scene/read_scene.h"

namespace weft::test {
namespace {

Scene sheet(int across, int along) {
    Scene scene = parse_scene(R"(
[scene]
frames = 1
dt = 0.01
[[cloth]]
name = "sheet"
grid = { size = [1.0, 1.0], resolution = [2, 2] }
density = 0.2
stretch = { stiffness = 1.0e4 }
bend = { stiffness = 1.0 }
)",
                              "test.toml");
    scene.cloths[0].shape = GridShape{{1.0, 1.0}, {across, along}};
    return scene;
}

/// E R^2 / (k area) of a sheet that is bent around a cylinder without stretching.
double cylinder_energy(int resolution, double radius) {
    Warnings warnings;
    const Model model(sheet(resolution, resolution), warnings);
    std::vector<float4> bent;
    for (const float4& flat : model.positions->span()) {
        const double angle = static_cast<double>(flat.x) / radius;
        bent.push_back(to_float4(
            {radius * std::sin(angle), radius * std::cos(angle), static_cast<double>(flat.z)}));
    }
    return model.find<Hinges>()->total_energy(bent) * radius * radius;
}

/// Only the edges along the axis bend, by t = 1 / ((n - 1) R) to each side:
/// E R^2 / k = 3/2 (n - 2) / (n - 1) (sin(t/2) / (t/2))^4, which tends to 3/2 of the continuum.
TEST(Hinges, CylinderHasTheEnergyOfTheClosedForm) {
    for (const double radius : {0.5, 1.0}) {
        for (const int n : {20, 40, 80}) {
            const double half = 0.5 / ((n - 1) * radius);
            const double expected = 1.5 * (n - 2) / (n - 1) * std::pow(std::sin(half) / half, 4.0);
            // Positions are rounded to 3e-8, and bends are differences of theirs.
            EXPECT_NEAR(cylinder_energy(n, radius), expected, 1e-4);
        }
    }
}

TEST(Hinges, FlatSheetAnywhereHasNoEnergy) {
    Warnings warnings;
    Scene scene = sheet(20, 20);
    scene.cloths[0].transform.rotations = {{{1.0, 2.0, 3.0}, 50.0}};
    scene.cloths[0].transform.translate = {1.0, -2.0, 0.5};
    const Model model(scene, warnings);
    EXPECT_LT(model.find<Hinges>()->total_energy(model.positions->span()),
              1e-6);  // of 1 J * curvature^2 * area
}

TEST(Hinges, WeightsSumToZeroAndIgnoreAffineMaps) {
    const auto q = hinge_weights({Vec3{0, 0, 0}, {1, 0.1, 0}, {0.4, 0.9, 0}, {0.7, -0.6, 0}});
    EXPECT_NEAR(q[0] + q[1] + q[2] + q[3], 0.0, 1e-12);
    EXPECT_NEAR(q[1] * 1.0 + q[2] * 0.4 + q[3] * 0.7, 0.0, 1e-12);
    EXPECT_NEAR(q[1] * 0.1 + q[2] * 0.9 - q[3] * 0.6, 0.0, 1e-12);
}

TEST(Model, MassIsThatOfTheArea) {
    Warnings warnings;
    const Model model(sheet(7, 11), warnings);
    double sum = 0.0;
    for (const double mass : model.masses) sum += mass;
    EXPECT_NEAR(sum, 0.2, 1e-12);
    for (std::size_t v = 0; v < model.masses.size(); ++v) {
        EXPECT_FLOAT_EQ((*model.positions)[v].w, static_cast<float>(1.0 / model.masses[v]));
    }
}

TEST(Model, HasNothingThatTheSceneDoesNotName) {
    Warnings warnings;
    Scene scene = sheet(5, 5);
    scene.cloths[0].bend.reset();
    const Model model(scene, warnings);
    EXPECT_EQ(model.find<Hinges>(), nullptr);
    EXPECT_EQ(model.moving_pins, nullptr);
    EXPECT_EQ(model.obstacles, nullptr);
    EXPECT_FALSE(model.damped);
}

TEST(Model, PinsAreHeldAndOnlyMovingOnesHaveATable) {
    Warnings warnings;
    Scene scene = sheet(5, 5);
    scene.cloths[0].pins.emplace_back().corners = {"x-z-"};
    const Model held(scene, warnings);
    EXPECT_EQ(held.moving_pins, nullptr);
    EXPECT_EQ((*held.positions)[static_cast<std::size_t>(held.strips.rank[0])].w, 0.0f);
    EXPECT_GT((*held.positions)[static_cast<std::size_t>(held.strips.rank[1])].w, 0.0f);
    scene.cloths[0].pins[0].motion = Motion{.velocity = {1.0, 0.0, 0.0}};
    EXPECT_NE(Model(scene, warnings).moving_pins, nullptr);
}

TEST(Model, SpringsKnowTheirMaterial) {
    Warnings warnings;
    const Model model(sheet(6, 9), warnings);
    for (int s = 0; s < model.find<Springs>()->elements().count(); ++s) {
        const auto ends = model.find<Springs>()->elements().vertices_of(s);
        const Vec3 along = to_vec3((*model.positions)[static_cast<std::size_t>(ends[0])]) -
                           to_vec3((*model.positions)[static_cast<std::size_t>(ends[1])]);
        EXPECT_NEAR(model.find<Springs>()->rest_length(s), length(along), 1e-6);
        EXPECT_NEAR(model.find<Springs>()->stiffness(s), 1.0e4, 1e-2);
    }
}

}  // namespace
}  // namespace weft::test
