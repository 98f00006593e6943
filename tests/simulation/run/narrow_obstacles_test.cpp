// Obstacles that are narrower than triangles do not pass between their vertices.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulation/families/convert.h"
#include "simulation/scene/read_scene.h"
#include "tests/simulation/run/one_plan.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

/// A sheet whose middle lies between two rows of vertices, 5 cm apart.
const std::string kSheet = R"(
[scene]
frames = 30
dt = 0.016666667
substeps = 8
[solver]
iterations = 8
[[cloth]]
grid = { size = [0.5, 0.5], resolution = [12, 12] }
translate = [0.0, 0.02, 0.0]
density = 0.2
stretch = { stiffness = 1.0e3 }
bend = { stiffness = 1.0e-4 }
)";

const std::string kLine = R"(
[[obstacle]]
name = "line"
shape = "capsule"
start = [0.0, 0.0, -1.0]
end = [0.0, 0.0, 1.0]
radius = 0.004
friction = 0.4
)";

const std::string kFastBar = R"(
[[obstacle]]
name = "bar"
shape = "box"
center = [0.0, 0.4, 0.0]
size = [0.012, 0.012, 1.0]
rotate = [0.0, 1.0, 0.0, 30.0]
motion = { velocity = [0.0, -20.0, 0.0] }
)";

const std::string kBlock = R"(
[scene]
frames = 20
dt = 0.016666667
substeps = 8
[solver]
iterations = 8
[[solid]]
grid = { size = [0.3, 0.3, 0.3], resolution = [4, 4, 4] }
density = 100.0
young = 1.0e5
poisson = 0.3
[[obstacle]]
shape = "capsule"
start = [-0.08, -0.165, -1.0]
end = [-0.08, -0.165, 1.0]
radius = 0.015
friction = 0.5
[[obstacle]]
shape = "capsule"
start = [0.08, -0.165, -1.0]
end = [0.08, -0.165, 1.0]
radius = 0.015
friction = 0.5
)";

class Narrow : public EverySolver {};

/// How far the nearest edge is from the z axis.
double nearest_edge(const ManualRun& run) {
    const auto x = positions(run);
    double nearest = 1e9;
    const auto look = [&](int a, int b) {
        const Vec3 from{at(x, a).x, at(x, a).y, 0.0},
            way = Vec3{at(x, b).x, at(x, b).y, 0.0} - from;
        const double part =
            dot(way, way) > 0.0 ? std::clamp(-dot(from, way) / dot(way, way), 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, length(from + part * way));
    };
    for (const auto& t : run.model->triangles) {
        for (std::size_t k = 0; k < 3; ++k) look(t[k], t[(k + 1) % 3]);
    }
    return nearest;
}

TEST_P(Narrow, SheetHangsOverALine) {
    ManualRun run(scene_of(kSheet + kLine));
    double fallen = 0.0;
    for (int frame = 0; frame < 30; ++frame) {
        run.run(1);
        EXPECT_GT(nearest_edge(run), 0.5 * 0.004) << "frame " << frame;
    }
    for (int v = 0; v < run.model->vertex_count(); ++v) fallen -= at(positions(run), v).y;
    fallen /= run.model->vertex_count();
    EXPECT_GT(fallen, 0.03) << "it hangs down on both sides";
    EXPECT_LT(fallen, 0.20) << "freely, it would have fallen by 1.2 m";
}

TEST_P(Narrow, FastBarTakesASheetAlong) {
    Scene scene = scene_of(kSheet + kFastBar);
    scene.gravity = {};
    ManualRun run(scene);
    run.run(4);
    double lowest = 1e9;
    for (int v = 0; v < run.model->vertex_count(); ++v) {
        lowest = std::min(lowest, at(positions(run), v).y);
    }
    const double bar = 0.4 - 20.0 * 4.0 * scene.dt;
    EXPECT_LT(lowest, bar) << "some of it is in front of the bar";
}

TEST_P(Narrow, BlockLiesOnTwoRods) {
    ManualRun run(scene_of(kBlock));
    run.run(20);
    const double y = momentum_of(run, 0).place.y;
    EXPECT_GT(y, -0.03);
    EXPECT_LT(y, 0.03) << "freely, it would have fallen by 0.54 m";
}

/// A blade of 2 mm below a sheet with cells of 5 cm, which falls onto it.
const std::string kBlade = R"(
[[obstacle]]
name = "blade"
shape = "box"
center = [0.0, -0.4, 0.0]
size = [0.002, 0.6, 2.0]
friction = 0.3
)";

TEST_P(Narrow, SheetIsNotCutByABlade) {
    ManualRun run(scene_of(kSheet + kBlade));
    run.run(30);
    const auto x = positions(run);
    const auto crosses = [&](int a, int b) {
        const Vec3 from = at(x, a), to = at(x, b);
        if (from.x * to.x >= 0.0) return false;
        const double y = from.y + (to.y - from.y) * from.x / (from.x - to.x);
        return y < -0.105 && y > -0.695;
    };
    int cut = 0;
    for (const auto& t : run.model->triangles) {
        for (std::size_t k = 0; k < 3; ++k) cut += crosses(t[k], t[(k + 1) % 3]) ? 1 : 0;
    }
    EXPECT_EQ(cut, 0);
}

/// A ball of 2 cm that goes through a sheet held by its corners, whatever is done.
const std::string kShot = R"(
pins = { corners = ["x-z-", "x+z-", "x-z+", "x+z+"] }
[[obstacle]]
name = "shot"
shape = "sphere"
center = [0.01, 0.5, 0.015]
radius = 0.01
motion = { velocity = [0.0, -100.0, 0.0] }
)";

TEST_P(Narrow, WhatGoesThroughIsTold) {
    Simulation simulation = simulation_of(scene_of(kSheet + kShot));
    for (int frame = 0; frame < 3; ++frame) simulation.advance();
    EXPECT_TRUE(std::ranges::any_of(simulation.troubles(), [](const Trouble& trouble) {
        return trouble.what.find("obstacle 'shot' has come up to") != std::string::npos;
    }));
}

/// What the run checks after each frame knows what such obstacles hold, and how they move.
TEST_P(Narrow, RunsHaveNoDoubts) {
    Scene scene = scene_of(kSheet + kLine);
    scene.obstacles[0].motion = Motion{.velocity = {0.0, 0.5, 0.0}};
    Simulation simulation = simulation_of(scene);
    for (int frame = 0; frame < 20; ++frame) simulation.advance();
    for (const Trouble& trouble : simulation.troubles()) ADD_FAILURE() << trouble.what;
}

TEST(NarrowObstacles, AreThoseThatTrianglesHaveRoomFor) {
    const auto has_narrow = [](double radius) {
        Scene scene = parse_scene(kSheet + kLine, "test.toml");
        scene.obstacles[0].half_width = radius;
        Warnings warnings;
        const Model model(scene, warnings);
        return model.obstacles->narrow() != nullptr;
    };
    const double longest = std::sqrt(2.0) * 0.5 / 11;
    EXPECT_TRUE(has_narrow(0.66 * longest));
    EXPECT_FALSE(has_narrow(0.67 * longest));
}

INSTANTIATE_TEST_SUITE_P(Methods, Narrow, kMethods, name_of_method);

}  // namespace
}  // namespace weft::test
