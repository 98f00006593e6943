// What convex obstacles bear, by few iterations: what lands on them gains no energy by that, and
// what is pressed on them by others stays where it is.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulation/families/convert.h"
#include "simulation/families/tetrahedra/tetrahedra.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

class Bearing : public EverySolver {};

const std::string kPlane = R"(
[[obstacle]]
shape = "plane"
point = [0, 0, 0]
thickness = 0.01
friction = 0.3
)";

/// A block of 4 kg on a sheet of 50 g on a plane.
const std::string kSandwich = R"(
[scene]
frames = 1
dt = 0.02
substeps = 5
[solver]
iterations = 8
[contact]
thickness = 0.01
friction = 0.3
[[cloth]]
grid = { size = [0.4, 0.4], resolution = [14, 14] }
translate = [0, 0.0105, 0]
density = 0.3
stretch = { stiffness = 1000 }
[[solid]]
grid = { size = [0.2, 0.1, 0.2], resolution = [5, 3, 5] }
translate = [0, 0.072, 0]
density = 1000
young = 2e5
poisson = 0.3
damping = 2
)" + kPlane;

/// Without the plane's reaction in the steps of bodies as wholes the block sank by 3 to 40 mm.
TEST_P(Bearing, ObstaclesBearWhatOthersPressOnThem) {
    ManualRun run(scene_of(kSandwich));
    const Vec3 before = momentum_of(run, 1).place;
    for (int frame = 0; frame < 40; ++frame) {
        run.run(1);
        const Vec3 gone = momentum_of(run, 1).place - before;
        EXPECT_LT(std::abs(gone.y), 2.5e-3) << "frame " << frame;
        EXPECT_LT(std::hypot(gone.x, gone.z), 5e-3) << "frame " << frame;
    }
}

/// Falls on an edge.
const std::string kTilted = R"(
[scene]
frames = 1
dt = 0.02
substeps = 8
[solver]
iterations = 8
[[solid]]
grid = { size = [0.4, 0.3, 0.3], resolution = [6, 5, 5] }
rotate = [0, 0, 1, 30]
translate = [0, 0.4, 0]
density = 1000
young = 5e6
poisson = 0.4
)" + kPlane;

double energy_of(const ManualRun& run) {
    const auto x = run.model->positions->span();
    double sum = run.model->find<Tetrahedra>()->total_energy(x);
    for (std::size_t v = 0; v < x.size(); ++v) {
        const Vec3 u = to_vec3((*run.model->velocities)[v]);
        sum += run.model->masses[v] * (0.5 * dot(u, u) + 9.81 * to_vec3(x[v]).y);
    }
    return sum;
}

TEST_P(Bearing, WhatLandsGainsHardlyAnyEnergy) {
    ManualRun run(scene_of(kTilted));
    const double start = energy_of(run);
    double most = 0.0;
    for (int frame = 0; frame < 25; ++frame) {
        run.run(1);
        most = std::max(most, energy_of(run) / start);
    }
    EXPECT_LT(most, 1.15);
    EXPECT_GT(most, 0.9);
}

INSTANTIATE_TEST_SUITE_P(Methods, Bearing,
                         testing::Values(Method::kVbd, Method::kSosd, Method::kJpgd,
                                         Method::kNewton),
                         name_of_method);

}  // namespace
}  // namespace weft::test
