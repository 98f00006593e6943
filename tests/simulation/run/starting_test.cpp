// Stiff bodies that are held, in steps that few iterations solve far too little: where a substep
// starts decides what is left in them. No energy comes from nowhere, and they go where they should.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/families/convert.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

const std::string kCorners = "corners = [\"x-z-\", \"x+z-\"]";
const std::string kCorner = "corners = [\"x-z-\"]";
const std::string kEdge = "edges = [\"z-\"]";

class Starting : public EverySolver {
protected:
    /// A sheet of 1 m and 0.2 kg. more: of its keys
    static Scene sheet(double stiffness, int substeps, const std::string& more) {
        return scene_of(fmt::format(R"(
[scene]
frames = 1
dt = 0.016666667
substeps = {}
[solver]
iterations = 4
[[cloth]]
grid = {{ size = [1.0, 1.0], resolution = [15, 15] }}
translate = [0.0, 1.0, 0.0]
density = 0.2
stretch = {{ stiffness = {} }}
{}
)",
                                    substeps, stiffness, more));
    }
    static Scene hung(double stiffness, int substeps, const std::string& pins) {
        return sheet(stiffness, substeps, "pins = [ { " + pins + " } ]");
    }

    static double strain_energy(const ManualRun& run) {
        double sum = 0.0;
        for (const auto& family : run.model->families)
            sum += family->total_energy(run.model->positions->span());
        return sum;
    }

    static double gravity_energy(const ManualRun& run, const Vec3& gravity) {
        const Momentum all = momentum_of(run, 0);
        return -all.mass * dot(gravity, all.place);
    }
};

/// Strain had been many times what gravity can give: 6 J and more at 1e4 N/m, hundreds at 1e6.
TEST_P(Starting, TakesNoEnergyFromNowhere) {
    constexpr std::pair<double, int> kCases[] = {{1e4, 1}, {1e6, 1}, {1e6, 4}, {1e8, 1}, {1e8, 4}};
    for (const auto& [stiffness, substeps] : kCases) {
        for (const std::string& pins : {kCorners, kCorner, kEdge}) {
            const Scene scene = hung(stiffness, substeps, pins);
            ManualRun run(scene);
            const double start = gravity_energy(run, scene.gravity);
            for (int frame = 0; frame < 30; ++frame) {
                run.run(1);
                const double had = start - gravity_energy(run, scene.gravity);
                EXPECT_LT(kinetic_energy(run) + strain_energy(run), 1.3 * had + 2.0)
                    << stiffness << " N/m, " << substeps << ' ' << pins << ", frame " << frame;
            }
            EXPECT_LT(momentum_of(run, 0).place.y, 0.75) << stiffness << ' ' << pins;
        }
    }
}

/// Turned, so that numbers are rounded: it had tumbled by itself.
TEST_P(Starting, FallsFreely) {
    for (const int substeps : {4, 16}) {
        const Scene scene = sheet(1e8, substeps, "rotate = [1.0, 0.0, 0.3, 40.0]");
        ManualRun run(scene);
        const double start = gravity_energy(run, scene.gravity);
        run.run(30);
        const double had = start - gravity_energy(run, scene.gravity);
        EXPECT_NEAR(kinetic_energy(run) + strain_energy(run), had, 0.02 * had) << substeps;
    }
}

/// At opposite corners it had been thrown about, too.
TEST_P(Starting, SagsOnSeveralSides) {
    const Scene scene = hung(1e6, 4, "corners = [\"x-z-\", \"x+z+\"]");
    ManualRun run(scene);
    const double start = gravity_energy(run, scene.gravity);
    for (int frame = 0; frame < 20; ++frame) {
        run.run(1);
        const double had = start - gravity_energy(run, scene.gravity);
        EXPECT_LT(kinetic_energy(run) + strain_energy(run), 1.3 * had + 0.04) << frame;
    }
}

/// Pins that travel, and a sheet that travels with them, are at rest to each other.
TEST_P(Starting, GoesAlongWithPins) {
    const Vec3 speed{3.0, -1.0, 2.0};
    Scene at_rest = hung(1e6, 1, kCorners);
    Scene travelling = hung(1e6, 1, kCorners + ", motion = { velocity = [3.0, -1.0, 2.0] }");
    ManualRun run(at_rest), along(travelling);
    for (float4& v : along.model->velocities->span()) {
        const float4 with{static_cast<float>(speed.x), static_cast<float>(speed.y),
                          static_cast<float>(speed.z), v.w};
        v = with;
    }
    along.changed(*along.model->velocities);
    run.run(20);
    along.run(20);
    const Vec3 way = 20.0 * at_rest.dt * speed;
    const Momentum all = momentum_of(run, 0);
    EXPECT_LT(length(momentum_of(along, 0).place - way - all.place), 5e-3);
    EXPECT_LT(strain_energy(along), 0.01);
}

/// What bends and moves smoothly keeps that: the shape that it had is the worse start.
TEST_P(Starting, KeepsWhatSwings) {
    const Scene scene = scene_of(R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 16
[solver]
iterations = 8
[[solid]]
grid = { size = [0.6, 0.1, 0.1], resolution = [13, 3, 3] }
density = 500.0
young = 3.0e7
poisson = 0.3
pins = { faces = ["x-"] }
)");
    Scene solved = scene;
    solved.solver.method = Method::kNewton;
    solved.solver.iterations = 12;
    ManualRun run(scene), reference(solved);
    double lowest = 0.0, expected = 0.0;
    for (int frame = 0; frame < 12; ++frame) {
        run.run(1);
        reference.run(1);
        lowest = std::min(lowest, momentum_of(run, 0).place.y);
        expected = std::min(expected, momentum_of(reference, 0).place.y);
    }
    EXPECT_NEAR(lowest, expected, 0.2 * std::abs(expected));
}

/// What obstacles push begins at x~, as they know nothing of shapes: it had been thrown about.
TEST_P(Starting, LeavesWhatObstaclesPush) {
    const Scene scene = scene_of(R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 4
[solver]
iterations = 16
[[cloth]]
grid = { size = [0.468, 0.468], resolution = [17, 17] }
translate = [0.0, 0.5, 0.0]
density = 0.219
stretch = { stiffness = 1.3e4 }
bend = { stiffness = 1.0e-4 }
pins = [ { corners = ["x-z-", "x+z-"], motion = { velocity = [0.77, 0.09, -0.15] } } ]
[[obstacle]]
shape = "box"
center = [0.21, 0.01, 0.2]
size = [0.27, 0.32, 0.58]
friction = 0.46
[[obstacle]]
shape = "sphere"
center = [0.05, 0.15, 0.14]
radius = 0.16
friction = 0.5
)");
    ManualRun run(scene);
    for (int frame = 0; frame < 60; ++frame) {
        run.run(1);
        EXPECT_LT(kinetic_energy(run) + strain_energy(run), 0.3) << frame;
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, Starting,
                         testing::Values(Method::kVbd, Method::kSosd, Method::kJpgd,
                                         Method::kNewton),
                         name_of_method);

/// Newton takes back what it strains until numbers are too short for that.
class StartingHard : public Starting {};

TEST_P(StartingHard, TakesNoEnergyFromNowhere) {
    const Scene scene = hung(1e10, 16, kEdge);
    ManualRun run(scene);
    const double start = gravity_energy(run, scene.gravity);
    for (int frame = 0; frame < 30; ++frame) {
        run.run(1);
        const double had = start - gravity_energy(run, scene.gravity);
        EXPECT_LT(kinetic_energy(run) + strain_energy(run), 1.1 * had + 0.01) << frame;
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, StartingHard,
                         testing::Values(Method::kVbd, Method::kSosd, Method::kNewton),
                         name_of_method);

}  // namespace
}  // namespace weft::test
