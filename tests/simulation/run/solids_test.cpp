// What physics says in closed form, or by a symmetry, about runs with solids, membranes and
// attachments.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "simulation/families/convert.h"
#include "simulation/families/springs/springs.h"
#include "simulation/families/tetrahedra/tetrahedra.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

class Solid : public EverySolver {};
class Membrane : public EverySolver {};
class Attachment : public EverySolver {};

const std::string kBrick = R"(
[scene]
frames = 1
dt = 0.016
substeps = 8
[solver]
iterations = 4
[[solid]]
name = "brick"
grid = { size = [1.0, 0.4, 0.3], resolution = [11, 5, 4] }
density = 800.0
young = 1.0e5
poisson = 0.45
)";

TEST_P(Solid, FallsFreelyWithAndWithoutDamping) {
    constexpr int kFrames = 20;
    for (const double damping : {0.0, 2.0}) {
        Scene scene = scene_of(kBrick);
        scene.gravity = {1.0, -9.81, 0.5};
        if (damping > 0.0) scene.solids[0].damping = damping;
        ManualRun run(scene);
        const auto start = positions(run);
        run.run(kFrames);
        const Fall fall = free_fall(scene, damping, kFrames);
        const auto now = positions(run);
        for (int vertex = 0; vertex < run.model->vertex_count(); ++vertex) {
            EXPECT_LT(length(at(now, vertex) - at(start, vertex) - fall.x), 1e-4);
        }
    }
}

TEST_P(Solid, AtRestStaysAtRest) {
    Scene scene = scene_of(kBrick);
    scene.gravity = {};
    scene.solids[0].transform.rotations = {{{1.0, 2.0, 3.0}, 40.0}};
    ManualRun run(scene);
    const auto start = positions(run);
    run.run(60);
    EXPECT_LT(difference(start, positions(run)), 1e-4);
    EXPECT_LT(difference(std::vector<float>(start.size()), velocities(run)), 1e-3);
}

TEST_P(Solid, InternalForcesHaveNoMomentum) {
    Scene scene = scene_of(kBrick);
    scene.gravity = {};
    if (GetParam() == Method::kJpgd) scene.solver.iterations = 200;  // only a minimum has none
    ManualRun run(scene);
    auto& x = *run.model->positions;
    for (std::size_t v = 0; v < x.count(); ++v) {  // stretched, bent and sheared, without symmetry
        x[v] = {1.01f * x[v].x + 0.01f * x[v].z, x[v].y + 0.05f * x[v].x * x[v].x,
                0.99f * x[v].z + 0.01f * x[v].x * x[v].y, x[v].w};
    }
    run.changed(x);
    EXPECT_GT(run_without_momentum(run, 10, 2e-3), 1e-1) << "it moves";
}

TEST_P(Solid, RotatedSceneGivesTheRotatedResult) {
    const auto run_rotated = [](double degrees) {
        Scene scene = scene_of(kBrick);
        const Vec3 axis{1.0, 2.0, -1.0};
        scene.gravity = rotation_matrix(axis, degrees) * Vec3{0.0, -9.81, 0.0};
        scene.solids[0].transform.rotations = {{axis, degrees}};
        scene.solids[0].pins.emplace_back().faces = {"x-"};
        ManualRun run(scene);
        run.run(15);
        return turned_back(positions(run), axis, degrees);
    };
    const auto straight = run_rotated(0.0);
    EXPECT_LT(difference(straight, run_rotated(90.0)), 2e-3);
    EXPECT_LT(difference(straight, run_rotated(33.0)), 2e-3);
}

TEST_P(Solid, MassAndStiffnessScaledTogetherChangeNoBit) {
    const auto run_scaled = [](double factor) {
        Scene scene = scene_of(kBrick);
        scene.solids[0].density *= factor;
        scene.solids[0].material.young *= factor;
        scene.solids[0].pins.emplace_back().faces = {"x-"};
        ManualRun run(scene);
        run.run(15);
        return positions(run);
    };
    // Powers of 4 are exact. 4^-16 makes vertices of about 1e-10 kg.
    const auto unscaled = run_scaled(1.0);
    EXPECT_EQ(unscaled, run_scaled(std::pow(4.0, -16)));
    EXPECT_EQ(unscaled, run_scaled(std::pow(4.0, 6)));
}

/// Random places in a ball around the middle, all shape lost.
TEST_P(Solid, ThrownAtRandomFindsBack) {
    Scene scene = scene_of(kBrick);
    // mu = 2e5 Pa, lambda = 1e6 Pa: lambda_L = 8e5 Pa.
    scene.solids[0].shape = BlockShape{{0.4, 0.4, 0.4}, {5, 5, 5}};
    scene.solids[0].material = {5.6e5, 0.4};
    scene.solids[0].damping = 2.0;
    scene.gravity = {};
    scene.guard = {1e20, 1e20};
    ManualRun run(scene);
    auto& x = *run.model->positions;
    std::mt19937 random(5);
    const auto coordinate = [&] {
        return 0.3f * (static_cast<float>(random() % 20001) / 10000.0f - 1.0f);
    };
    for (std::size_t v = 0; v < x.count(); ++v)
        x[v] = {coordinate(), coordinate(), coordinate(), x[v].w};
    run.changed(x);
    const double start = run.model->find<Tetrahedra>()->total_energy(x.span());
    run.run(300);
    EXPECT_LT(run.model->find<Tetrahedra>()->total_energy(x.span()), 1e-6 * start);
    EXPECT_LT(run.model->edges->strain(x.span()).most, 1e-3);
}

const std::string kStrip = R"(
[scene]
frames = 1
dt = 0.02
substeps = 40
gravity = [0.0, 0.0, 0.0]
[solver]
iterations = 10
[[cloth]]
name = "strip"
grid = { size = [0.8, 0.2], resolution = [17, 5] }
density = 0.2
membrane = { young = 1.0e6, poisson = 0.3, thickness = 1.0e-3 }
damping = 20.0
[[cloth.pins]]
box = [[-0.4, -1.0, -1.0], [-0.39, 1.0, 1.0]]
[[cloth.pins]]
box = [[0.39, -1.0, -1.0], [0.4, 1.0, 1.0]]
motion.keyframes = [{ time = 0.0 }, { time = 0.5, translate = [0.8, 0.0, 0.0] }]
)";

/// A/A0 = 2 L^2 / ((1 - nu) + (1 + nu) L^2), in the middle, away from the clamps.
TEST_P(Membrane, StretchedStripNarrowsByTheClosedForm) {
    ManualRun run(scene_of(kStrip));
    const auto start = positions(run);
    run.run(100);
    const auto now = positions(run);
    const auto vertex = [](int along, int across) { return across * 17 + along; };
    const auto ratio = [&](int a, int b) {
        return length(at(now, a) - at(now, b)) / length(at(start, a) - at(start, b));
    };
    const double L = ratio(vertex(6, 2), vertex(10, 2));
    const double width = ratio(vertex(8, 0), vertex(8, 4));
    EXPECT_NEAR(L, 2.0, 0.1);
    EXPECT_NEAR(L * width, 2.0 * L * L / (0.7 + 1.3 * L * L), 0.005);
    EXPECT_LT(difference(std::vector<float>(now.size()), velocities(run)), 1e-2) << "it rests";
}

TEST_P(Membrane, AtRestStaysAtRest) {
    Scene scene = scene_of(kStrip);
    scene.cloths[0].pins.clear();
    scene.cloths[0].transform.rotations = {{{1.0, 2.0, 3.0}, 40.0}};
    ManualRun run(scene);
    const auto start = positions(run);
    run.run(30);
    EXPECT_LT(difference(start, positions(run)), 1e-4);
}

const std::string kTied = R"(
[scene]
frames = 1
dt = 0.016
substeps = 20
[solver]
iterations = 20
[[cloth]]
name = "net"
grid = { size = [0.4, 0.4], resolution = [5, 5] }
density = 0.2
stretch = { stiffness = 1.0e3 }
damping = 10.0
pins = { corners = ["x-z-", "x+z-", "x-z+", "x+z+"] }
[[solid]]
name = "load"
grid = { size = [0.2, 0.2, 0.2], resolution = [3, 3, 3] }
translate = [0.0, -0.1, 0.0]
density = 100.0
young = 1.0e5
poisson = 0.3
damping = 10.0
[[attachment]]
a = "load"
b = "net"
faces = ["y+"]
stiffness = 1.0e3
)";

TEST_P(Attachment, CarriesTheWeightOfWhatHangsOnIt) {
    ManualRun run(scene_of(kTied));
    const Model& model = *run.model;
    run.run(200);
    double weight = 0.0;
    double force = 0.0;
    for (int v = 0; v < model.vertex_count(); ++v) {
        const bool is_of_load = model.strips.order[static_cast<std::size_t>(v)] >= 25;
        if (is_of_load) weight += 9.81 * model.masses[static_cast<std::size_t>(v)];
    }
    const Springs& springs = *model.find<Springs>();
    int ties = 0;
    for (int s = 0; s < springs.elements().count(); ++s) {
        if (springs.is_edge(s)) continue;
        ++ties;
        const auto ends = springs.elements().vertices_of(s);
        const auto in_scene = [&](std::size_t end) {
            return model.strips.order[static_cast<std::size_t>(ends[end])];
        };
        const std::size_t net = in_scene(0) < 25 ? 0 : 1;
        EXPECT_GE(in_scene(1 - net), 25) << "from one body to the other";
        const Vec3 along = to_vec3((*model.positions)[static_cast<std::size_t>(ends[net])]) -
                           to_vec3((*model.positions)[static_cast<std::size_t>(ends[1 - net])]);
        EXPECT_EQ(springs.rest_length(s), 0.0);
        EXPECT_LT(length(along), 5e-3);
        force += springs.stiffness(s) * along.y;
    }
    EXPECT_EQ(ties, 9);
    // XPBD at rest: 5 % off with 10 substeps, 1 % with 20, whatever the iterations.
    EXPECT_NEAR(force, weight, 0.02 * weight);
    EXPECT_NEAR(weight, 9.81 * 0.8, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Methods, Solid, kMethods, name_of_method);
INSTANTIATE_TEST_SUITE_P(Methods, Membrane, kMethods, name_of_method);
INSTANTIATE_TEST_SUITE_P(Methods, Attachment, kMethods, name_of_method);

}  // namespace
}  // namespace weft::test
