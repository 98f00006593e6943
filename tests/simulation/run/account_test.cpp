// Where the energy of a run comes from, and where it goes.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "tests/simulation/run/one_plan.h"
#include "tests/simulation/run/physics.h"
#include "tests/simulation/run/test_scenes.h"

namespace weft::test {
namespace {

class EveryAccount : public EverySolver {
protected:
    /// Every frame's record; fails where something was wrong.
    static std::vector<FrameRecord> run(const Scene& scene) {
        Simulation simulation = simulation_of(scene, OnTrouble::kStop);
        std::vector<FrameRecord> frames;
        while (simulation.frame() < scene.frames) frames.push_back(simulation.advance());
        EXPECT_TRUE(simulation.troubles().empty());
        return frames;
    }
};

double total(const FrameRecord& frame) {
    double sum = frame.kinetic_energy + frame.gravity_energy;
    for (const double energy : frame.energies) sum += energy;
    return sum;
}

/// A sheet that hangs is lifted by its pins: what they do ends as height, or is lost.
TEST_P(EveryAccount, BooksTheWorkOfPins) {
    const auto frames = run(scene_of(R"(
[scene]
frames = 60
dt = 0.016666667
substeps = 20
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [9, 9] }
rotate = [1.0, 0.0, 0.0, 90.0]
density = 0.2
stretch = { stiffness = 1.0e3 }
damping = 2.0
[cloth.pins]
edges = ["z-"]
motion = { velocity = [0.0, 0.5, 0.0] }
)"));
    const double lifted = frames.back().gravity_energy - frames[20].gravity_energy;
    const double work = frames.back().work - frames[20].work;
    EXPECT_GT(lifted, 0.4);
    EXPECT_NEAR(work, lifted, 0.15 * lifted);
    EXPECT_GT(frames.back().dissipated, -0.05 * frames.back().work);
}

/// What is carried along as a whole, from one moment to the next: the pins' push is all of the
/// momentum that is not gravity's, and nothing is lost before it was there.
TEST_P(EveryAccount, BooksThePushOfPinsExactly) {
    const auto frames = run(scene_of(R"(
[scene]
frames = 12
dt = 0.016666667
substeps = 40
gravity = [0.0, 0.0, 0.0]
[solver]
iterations = 30
[[cloth]]
grid = { size = [0.2, 0.2], resolution = [4, 4] }
density = 0.2
stretch = { stiffness = 1.0e2 }
[cloth.pins]
edges = ["z-"]
motion = { velocity = [0.0, 0.0, -0.5] }
)"));
    const double mass = 0.008 * 0.75;  // less the pins' row, about
    for (const FrameRecord& frame : frames) {
        EXPECT_NEAR(frame.work - total(frame), frame.dissipated, 1e-12);
        EXPECT_GT(frame.dissipated, -0.01 * mass * 0.25) << frame.frame;
    }
    EXPECT_GT(frames.back().work, 0.5 * mass * 0.25);
}

/// The same by a table that rises below it.
TEST_P(EveryAccount, BooksTheWorkOfObstacles) {
    const auto frames = run(scene_of(R"(
[scene]
frames = 40
dt = 0.016666667
substeps = 10
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [9, 9] }
translate = [0.0, 0.01, 0.0]
density = 0.2
stretch = { stiffness = 1.0e3 }
[[obstacle]]
shape = "plane"
point = [0.0, 0.0, 0.0]
motion = { velocity = [0.0, 0.5, 0.0] }
)"));
    const double lifted = frames.back().gravity_energy - frames[10].gravity_energy;
    EXPECT_GT(lifted, 0.2);
    EXPECT_NEAR(frames.back().work - frames[10].work, lifted, 0.05 * lifted);
}

/// A belt takes cloth along: half of its work is motion in the end, and half is rubbed away.
TEST_P(EveryAccount, BooksTheWorkOfABelt) {
    const auto frames = run(scene_of(R"(
[scene]
frames = 20
dt = 0.016666667
substeps = 10
[[cloth]]
grid = { size = [0.2, 0.2], resolution = [5, 5] }
translate = [0.0, 0.0021, 0.0]
density = 0.3
stretch = { stiffness = 1.0e3 }
[[obstacle]]
shape = "plane"
point = [0.0, 0.0, 0.0]
thickness = 0.002
friction = 0.5
motion = { velocity = [0.5, 0.0, 0.0] }
)"));
    const double work = 0.3 * 0.2 * 0.2 * 0.5 * 0.5;  // m v^2
    EXPECT_NEAR(frames.back().kinetic_energy, 0.5 * work, 0.02 * work);
    EXPECT_NEAR(frames.back().work, work, 0.05 * work);
    EXPECT_NEAR(frames.back().dissipated, 0.5 * work, 0.05 * work);
}

/// What slides along under cloth without rubbing it does nothing, however the cloth is pulled.
TEST_P(EveryAccount, BooksNoWorkOfWhatSlidesWithoutFriction) {
    const auto frames = run(scene_of(R"(
[scene]
frames = 10
dt = 0.016666667
substeps = 10
gravity = [5.0, -9.81, 0.0]
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [9, 9] }
density = 0.2
stretch = { stiffness = 1.0e3 }
pins = { edges = ["x-"] }
[[obstacle]]
shape = "plane"
point = [0.0, 0.0, 0.0]
motion = { velocity = [20.0, 0.0, 0.0] }
)"));
    for (const FrameRecord& frame : frames) EXPECT_NEAR(frame.work, 0.0, 1e-9) << frame.frame;
}

/// Gravity that turns upside down does work where it stands.
TEST_P(EveryAccount, BooksTheWorkOfGravityThatChanges) {
    Scene scene = scene_of(R"(
[scene]
frames = 30
dt = 0.01
substeps = 2
gravity_keyframes = [[0.0, 0.0, -9.81, 0.0], [0.1, 0.0, -9.81, 0.0], [0.2, 0.0, 9.81, 0.0]]
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [5, 5] }
translate = [0.0, 2.0, 0.0]
density = 0.2
stretch = { stiffness = 1.0e3 }
)");
    for (const FrameRecord& frame : run(scene)) {
        EXPECT_NEAR(frame.dissipated, 0.0, 0.02) << frame.frame;  // by steps of that length
        EXPECT_NEAR(frame.work - total(frame), frame.dissipated + 0.2 * -9.81 * 2.0, 1e-4);
    }
}

/// Until a seam is closed, the ends of a frame do not tell what it does.
TEST(Account, IsNotKnownWhileSeamsClose) {
    Scene scene = parse_scene(kSewn, "test.toml");
    scene.seams.pop_back();  // the one that stays open
    Simulation simulation = simulation_of(scene, OnTrouble::kReport);
    const double closed = scene.seams[0].time;
    while (simulation.frame() < scene.frames) {
        const bool was_open = simulation.time() < closed;
        EXPECT_EQ(std::isnan(simulation.advance().dissipated), was_open);
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryAccount, kMethods, name_of_method);

}  // namespace
}  // namespace weft::test
