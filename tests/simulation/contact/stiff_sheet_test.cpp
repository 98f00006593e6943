// A heavy solid that falls on a light, stiff sheet on the ground, by settings that nobody tuned.

#include <gtest/gtest.h>

#include <algorithm>

#include "simulation/scene/read_scene.h"
#include "simulation/state/diagnostics.h"
#include "tests/simulation/run/one_plan.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

/// The sheet has a hundredth of the block's mass, and friction on both sides.
const char* const kBlockOnStiffSheet = R"(
[scene]
frames = 90
dt = 0.016666667
[contact]
friction = 0.6
[[cloth]]
grid = { size = [0.8, 0.8], resolution = [20, 20] }
translate = [0.0, 0.05, 0.0]
density = 0.1
stretch = { stiffness = 3.0e5 }
[[obstacle]]
shape = "plane"
point = [0.0, 0.0, 0.0]
friction = 0.6
[[solid]]
grid = { size = [0.2, 0.2, 0.2], resolution = [6, 6, 6] }
rotate = [1.0, 0.0, 0.4, 10.0]
translate = [0.0, 0.4, 0.0]
density = 1000.0
young = 1.0e7
poisson = 0.45
)";

class StiffSheet : public testing::TestWithParam<Method> {};

/// The sheet went as far as the block's friction led it, the ground's brought it back, and what
/// that strained threw the block up by decimetres.
TEST_P(StiffSheet, BearsABlockThatLies) {
    Scene scene = parse_scene(kBlockOnStiffSheet, "test.toml");
    scene.solver.method = GetParam();
    Simulation simulation = simulation_of(scene);
    double gained = 0.0;
    double motion = 0.0;
    double least = 1e30;
    double most = 0.0;
    while (simulation.frame() < scene.frames) {
        gained = std::max(gained, simulation.advance().gained);
        if (simulation.frame() < 75) continue;
        const Energies energies = simulation.energies();
        motion = std::max(motion, energies.kinetic);
        least = std::min(least, energies.gravity);
        most = std::max(most, energies.gravity);
    }
    EXPECT_LT(gained, 0.1) << "of 30 J that it falls with";
    EXPECT_LT(motion, 0.01);
    EXPECT_LT(most - least, 0.05);
    EXPECT_TRUE(simulation.troubles().empty());
}

INSTANTIATE_TEST_SUITE_P(Methods, StiffSheet,
                         testing::Values(Method::kXpbd, Method::kVbd, Method::kSosd, Method::kJpgd),
                         name_of_method);

}  // namespace
}  // namespace weft::test
