// The work of pins that turn, from what everything else gains of angular momentum.

#include <gtest/gtest.h>

#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "tests/simulation/run/one_plan.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

/// That nothing comes near.
const std::string kSphere = R"(
[[obstacle]]
shape = "sphere"
center = [0.0, -3.0, 0.0]
radius = 0.5
friction = 0.5
)";

class PinWork : public EverySolver {
protected:
    static std::vector<FrameRecord> run(const Scene& scene) {
        Simulation simulation = simulation_of(scene, OnTrouble::kStop);
        std::vector<FrameRecord> frames;
        while (simulation.frame() < scene.frames) frames.push_back(simulation.advance());
        EXPECT_TRUE(simulation.troubles().empty());
        return frames;
    }

    /// A sheet of 0.2 m that is turned by an edge, in steps that are solved.
    static Scene turned(const std::string& motion, int substeps = 40,
                        const std::string& obstacle = "") {
        Scene scene = scene_of(R"(
[scene]
frames = 8
dt = 0.016666667
gravity = [0.0, 0.0, 0.0]
[[cloth]]
grid = { size = [0.2, 0.2], resolution = [6, 6] }
density = 0.2
stretch = { stiffness = 1.0e2 }
[cloth.pins]
edges = ["z-"]
motion = { )" + motion + " }\n" +
                               obstacle);
        scene.substeps = substeps;
        scene.solver.iterations = GetParam() == Method::kNewton ? 4 : 30;
        return scene;
    }
};

/// Nothing is lost before it was there, and nothing that was lost comes back.
void expect_losses_grow(const std::vector<FrameRecord>& frames) {
    double before = 0.0;
    for (const FrameRecord& frame : frames) {
        EXPECT_GE(frame.dissipated, before - 0.01 * frame.kinetic_energy) << frame.frame;
        before = frame.dissipated;
    }
    EXPECT_GT(before, 0.0);
}

TEST_P(PinWork, IsAllThatTurnedClothHas) {
    const std::string motion = "angular_velocity = 360.0, center = [0.0, 0.0, -0.1]";
    const auto frames = run(turned(motion));
    expect_losses_grow(frames);
    // What is lost is the steps' doing: little, and less in shorter ones.
    const auto shorter = run(turned(motion, 160));
    expect_losses_grow(shorter);
    EXPECT_LT(shorter.back().dissipated, 0.2 * shorter.front().work);
    EXPECT_LT(shorter.back().dissipated, 0.6 * frames.back().dissipated);
    EXPECT_NEAR(shorter.front().work, frames.front().work, 0.03 * frames.front().work);
}

/// Far from the axis the pins push, too, and along it.
TEST_P(PinWork, IsKnownOffTheAxisAndAlongIt) {
    expect_losses_grow(run(turned("angular_velocity = 360.0, center = [0.5, 0.0, 0.3]")));
    expect_losses_grow(run(turned("angular_velocity = 360.0, velocity = [0.0, 1.0, 0.0]")));
}

/// Gravity turns, too, and damping holds against it.
TEST_P(PinWork, IsKnownBesideGravityAndDamping) {
    Scene scene =
        turned("angular_velocity = 360.0, axis = [0.0, 0.0, 1.0], center = [0.3, 0.0, -0.1]");
    scene.gravity = {0.0, -9.81, 0.0};
    scene.cloths[0].damping = 2.0;
    scene.cloths[0].stretch.stiffness = 1.0e3;
    expect_losses_grow(run(scene));
}

/// So that turning is no excuse for energy from nowhere, nor an obstacle that nothing touches.
TEST_P(PinWork, LetsTroubleBeSeen) {
    if (GetParam() == Method::kNewton) return;  // it solves them
    for (const std::string& obstacle : {std::string(), kSphere}) {
        const Scene scene = scene_of(R"(
[scene]
frames = 12
dt = 0.016666667
substeps = 1
[solver]
iterations = 2
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [40, 40] }
density = 0.2
stretch = { stiffness = 1.0e5 }
[cloth.pins]
corners = ["x-z-", "x+z-"]
motion = { angular_velocity = 200.0, center = [0.0, 0.0, -0.5] }
)" + obstacle);
        Simulation simulation = simulation_of(scene, OnTrouble::kReport);
        while (simulation.frame() < scene.frames) simulation.advance();
        ASSERT_FALSE(simulation.troubles().empty());
        const std::string& said = simulation.troubles()[0].what;
        EXPECT_NE(said.find("energy from nowhere"), std::string::npos) << said;
    }
}

/// An obstacle is no reason not to know what pins do, before anything touches it.
TEST_P(PinWork, IsKnownBesideObstacles) {
    const std::string motion = "angular_velocity = 360.0, center = [0.5, 0.0, 0.3]";
    const auto expected = run(turned(motion)), found = run(turned(motion, 40, kSphere));
    for (std::size_t frame = 0; frame < found.size(); ++frame)
        EXPECT_EQ(found[frame].work, expected[frame].work) << frame;
}

INSTANTIATE_TEST_SUITE_P(Methods, PinWork, kMethods, name_of_method);

}  // namespace
}  // namespace weft::test
