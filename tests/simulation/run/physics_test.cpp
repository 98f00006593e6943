// What physics says in closed form, or by a symmetry, about whole runs.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulation/families/springs/springs.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

const std::string kSheet = R"(
[scene]
frames = 1
dt = 0.016
substeps = 8
[solver]
iterations = 4
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [12, 14] }
density = 0.2
stretch = { stiffness = 1.0e3 }
bend = { stiffness = 1.0e-3 }
)";

TEST_P(EverySolver, FreeFallIsExactWithAndWithoutDamping) {
    constexpr int kFrames = 20;
    for (const double damping : {0.0, 2.0}) {
        Scene scene = scene_of(kSheet);
        scene.gravity = {1.0, -9.81, 0.5};
        if (damping > 0.0) scene.cloths[0].damping = damping;
        ManualRun run(scene);
        const auto start = positions(run);
        run.run(kFrames);
        const Fall fall = free_fall(scene, damping, kFrames);
        for (int vertex = 0; vertex < run.model->vertex_count(); ++vertex) {
            EXPECT_LT(length(at(positions(run), vertex) - at(start, vertex) - fall.x), 4e-5);
            EXPECT_LT(length(at(velocities(run), vertex) - fall.v), 2e-3);
        }
        EXPECT_LT(run.model->find<Springs>()->total_energy(run.model->positions->span()), 1e-8);
    }
}

TEST_P(EverySolver, RestStaysAtRest) {
    Scene scene = scene_of(kSheet);
    scene.gravity = {};
    scene.cloths[0].transform.rotations = {{{1.0, 2.0, 3.0}, 40.0}};
    ManualRun run(scene);
    const auto start = positions(run);
    run.run(60);
    EXPECT_LT(difference(start, positions(run)), 1e-4);  // about one rounding per substep
    EXPECT_LT(difference(std::vector<float>(start.size()), velocities(run)), 1e-3);
}

/// A vertex that hangs from two pins by the springs of one triangle.
TEST_P(EverySolver, VertexOnTwoSpringsHangsWhereTheClosedFormSays) {
    Scene scene = scene_of(kSheet);
    scene.cloths[0].shape = GridShape{{2.0, 1.0}, {2, 2}};
    scene.cloths[0].bend.reset();
    scene.cloths[0].stretch.stiffness = 20.0;
    scene.cloths[0].damping = 5.0;
    scene.cloths[0].pins.emplace_back().vertices = {0, 1, 3};
    if (GetParam() == Method::kJpgd) scene.solver.iterations = 20;
    // Vertex 2 hangs from 0 by the side (length 1) and from 3 and 1 by the other edges; the cells'
    // diagonal is 1 - 2, of length sqrt(5).
    ManualRun run(scene);
    const auto start = positions(run);
    run.run(1500);
    const Vec3 x = at(positions(run), 2);
    Vec3 force;
    double mass = 0.0;
    for (int v = 0; v < 4; ++v) {
        if (run.model->strips.order[static_cast<std::size_t>(v)] == 2) {
            mass = run.model->masses[static_cast<std::size_t>(v)];
        }
        if (v == 2) continue;
        const Vec3 along = at(start, v) - x;
        const double rest = length(at(start, v) - at(start, 2));
        force = force + (20.0 * (length(along) - rest) / length(along)) * along;
    }
    EXPECT_LT(length(at(velocities(run), 2)), 1e-3);
    EXPECT_GT(x.y, -10.0);
    EXPECT_LT(x.y, -0.01);
    EXPECT_NEAR(force.y, mass * 9.81, 2e-3 * mass * 9.81);
    EXPECT_NEAR(force.x, 0.0, 2e-3 * mass * 9.81);
    EXPECT_NEAR(force.z, 0.0, 2e-3 * mass * 9.81);
}

TEST_P(EverySolver, EveryCutOfAHangingSheetCarriesTheWeightBelow) {
    constexpr int kAcross = 4;
    constexpr int kDown = 9;
    Scene scene = scene_of(kSheet);
    scene.solver.iterations = 20;
    Cloth& cloth = scene.cloths[0];
    cloth.shape = GridShape{{0.3, 0.8}, {kAcross, kDown}};
    cloth.stretch.stiffness = 200.0;
    cloth.bend.reset();
    cloth.damping = 4.0;
    cloth.transform.rotations = {{{1.0, 0.0, 0.0}, 90.0}};
    cloth.pins.emplace_back().vertices = {0, 1, 2, 3};
    ManualRun run(scene);
    const auto start = positions(run);
    ASSERT_GT(at(start, 0).y, at(start, kAcross * kDown - 1).y) << "hangs downwards";
    run.run(400);

    const Model& model = *run.model;
    for (int row = 1; row < kDown; ++row) {
        double weight = 0.0;
        double force = 0.0;
        for (int v = 0; v < model.vertex_count(); ++v) {
            const bool is_below = model.strips.order[static_cast<std::size_t>(v)] >= row * kAcross;
            if (is_below) weight += 9.81 * model.masses[static_cast<std::size_t>(v)];
        }
        const auto now = positions(run);
        for (int s = 0; s < model.find<Springs>()->elements().count(); ++s) {
            const auto ends = model.find<Springs>()->elements().vertices_of(s);
            const int a = model.strips.order[static_cast<std::size_t>(ends[0])];
            const int b = model.strips.order[static_cast<std::size_t>(ends[1])];
            if ((a >= row * kAcross) == (b >= row * kAcross)) continue;
            const Vec3 along = a < b ? at(now, a) - at(now, b) : at(now, b) - at(now, a);
            const double stretch = length(along) - model.find<Springs>()->rest_length(s);
            force += model.find<Springs>()->stiffness(s) * stretch * along.y / length(along);
        }
        EXPECT_NEAR(force, weight, 0.01 * weight) << "above row " << row;
    }
}

TEST_P(EverySolver, RotatedSceneGivesTheRotatedResult) {
    const auto run_rotated = [](double degrees) {
        Scene scene = scene_of(kSheet);
        const Vec3 axis{1.0, 2.0, -1.0};
        scene.gravity = rotation_matrix(axis, degrees) * Vec3{0.0, -9.81, 0.0};
        scene.cloths[0].transform.rotations = {{axis, degrees}};
        scene.cloths[0].pins.emplace_back().corners = {"x-z-", "x+z-"};
        ManualRun run(scene);
        run.run(15);
        return turned_back(positions(run), axis, degrees);
    };
    const auto straight = run_rotated(0.0);
    EXPECT_LT(difference(straight, run_rotated(90.0)), 2e-3);
    EXPECT_LT(difference(straight, run_rotated(33.0)), 2e-3);
}

TEST_P(EverySolver, MassAndStiffnessScaledTogetherChangeNoBit) {
    const auto run_scaled = [](double factor) {
        Scene scene = scene_of(kSheet);
        Cloth& cloth = scene.cloths[0];
        cloth.density *= factor;
        cloth.stretch.stiffness *= factor;
        cloth.bend->stiffness *= factor;
        cloth.pins.emplace_back().corners = {"x-z-", "x+z-"};
        ManualRun run(scene);
        EXPECT_GT(run.model->masses[0], 0.0);
        run.run(15);
        return positions(run);
    };
    // Powers of 4, whose roots are exact, too. 4^-12 makes vertices of 1e-10 kg.
    const auto unscaled = run_scaled(1.0);
    EXPECT_EQ(unscaled, run_scaled(std::pow(4.0, -12)));
    EXPECT_EQ(unscaled, run_scaled(std::pow(4.0, 8)));
    EXPECT_LT(difference(unscaled, run_scaled(1e-7)), 2e-3);  // other factors round
}

TEST_P(EverySolver, MomentumOfInternalForcesIsConserved) {
    Scene scene = scene_of(kSheet);
    scene.gravity = {};
    ManualRun run(scene);
    auto& x = *run.model->positions;
    for (std::size_t v = 0; v < x.count(); ++v) {  // stretched, bent and sheared, without symmetry
        x[v] = {1.01f * x[v].x + 0.01f * x[v].z, 0.05f * x[v].x * x[v].x + 0.01f * x[v].z,
                0.99f * x[v].z + 0.01f * x[v].x * x[v].z, x[v].w};
    }
    run.changed(x);
    EXPECT_GT(run_without_momentum(run, 10, 2e-3), 1e-3) << "it moves";
}

const std::string kOnPlane = R"(
[scene]
frames = 1
dt = 0.016
substeps = 8
[solver]
iterations = 4
[[cloth]]
grid = { size = [0.5, 0.5], resolution = [8, 8] }
density = 0.2
stretch = { stiffness = 1.0e3 }
[[obstacle]]
shape = "plane"
point = [0.0, 0.0, 0.0]
friction = 0.5
)";

TEST_P(EverySolver, ClothOnAPlaneDoesNotPenetrate) {
    Scene scene = scene_of(kOnPlane);
    scene.cloths[0].transform.translate = {0.0, 0.05, 0.0};
    scene.cloths[0].transform.rotations = {{{1.0, 0.0, 1.0}, 5.0}};
    scene.obstacles[0].thickness = 0.004;
    ManualRun run(scene);
    for (int frame = 0; frame < 60; ++frame) {
        run.run(1);
        for (const float4& x : run.model->positions->span()) ASSERT_GT(x.y, 0.004f - 1e-6f);
    }
    for (const float4& x : run.model->positions->span()) ASSERT_LT(x.y, 0.01f) << "it has landed";
}

TEST_P(EverySolver, FrictionHoldsBelowItsAngleAndLetsSlideAboveIt) {
    // Tilted gravity over a level plane is a level gravity over a tilted plane.
    constexpr double kFriction = 0.5;
    constexpr int kFrames = 30;
    for (const double degrees : {10.0, 25.0, 28.0, 40.0, 60.0}) {
        const double angle = degrees * std::numbers::pi / 180.0;
        Scene scene = scene_of(kOnPlane);
        scene.gravity = {9.81 * std::sin(angle), -9.81 * std::cos(angle), 0.0};
        ManualRun run(scene);
        const auto start = positions(run);
        run.run(kFrames);
        const double down = 9.81 * (std::sin(angle) - kFriction * std::cos(angle));
        const double h = scene.dt / scene.substeps;
        const double n = kFrames * scene.substeps;
        const double expected = std::max(0.0, down) * h * h * n * (n + 1.0) / 2.0;
        for (int v = 0; v < run.model->vertex_count(); ++v) {
            EXPECT_NEAR(at(positions(run), v).x - at(start, v).x, expected, 1e-3 + 0.01 * expected)
                << degrees << " degrees";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Physics, EverySolver, kMethods, name_of_method);

}  // namespace
}  // namespace weft::test
