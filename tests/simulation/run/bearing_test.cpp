// What convex obstacles bear, by few iterations: neither what lands on them nor what is piled up
// there gains energy by that.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

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

/// The most in so many frames, in parts of that at the start.
double most_energy(ManualRun& run, int frames) {
    const double start = energy_of(run);
    double most = 0.0;
    for (int frame = 0; frame < frames; ++frame) {
        run.run(1);
        most = std::max(most, energy_of(run) / start);
    }
    return most;
}

/// It was 2.4 times by jpgd.
TEST_P(Bearing, WhatLandsGainsHardlyAnyEnergy) {
    ManualRun run(scene_of(kTilted));
    const double most = most_energy(run, 25);
    EXPECT_LT(most, 1.15);
    EXPECT_GT(most, 0.9);
}

std::string block(int number, int density) {
    return "[[solid]]\ngrid = { size = [0.2, 0.1, 0.2], resolution = [4, 3, 4] }\n"
           "translate = [0, " +
           std::to_string(0.0605 + 0.111 * number) + ", 0]\nrotate = [0, 1, 0, " +
           std::to_string(17 * number) + "]\ndensity = " + std::to_string(density) +
           "\nyoung = 1e6\npoisson = 0.3\n";
}

/// Each ten times as heavy as what it lies on. It was 3.2 times by vbd, and 1.37 by newton.
TEST_P(Bearing, HeavyPilesGainHardlyAnyEnergy) {
    const std::string head = R"(
[scene]
frames = 1
dt = 0.02
substeps = 4
[solver]
iterations = 8
[contact]
thickness = 0.01
friction = 0.3
)";
    ManualRun run(scene_of(head + block(0, 100) + block(1, 1000) + block(2, 10000) + kPlane));
    EXPECT_LT(most_energy(run, 40), 1.1);
}

INSTANTIATE_TEST_SUITE_P(Methods, Bearing,
                         testing::Values(Method::kVbd, Method::kSosd, Method::kJpgd,
                                         Method::kNewton),
                         name_of_method);

}  // namespace
}  // namespace weft::test
