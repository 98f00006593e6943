// What is done where the energy of a run comes from nowhere.

#include <gtest/gtest.h>

#include "runtime/error.h"
#include "runtime/opencl/opencl_device.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "tests/simulation/run/one_plan.h"
#include "tests/simulation/run/physics.h"
#include "tests/simulation/run/test_scenes.h"

namespace weft::test {
namespace {

/// A stiff sheet in steps that are far too long for two iterations.
const std::string kTooLong = R"(
[scene]
frames = 12
dt = 0.016666667
substeps = 1
[solver]
iterations = 2
[[cloth]]
name = "sheet"
grid = { size = [1.0, 1.0], resolution = [40, 40] }
density = 0.2
stretch = { stiffness = 1.0e5 }
damping = 0.1
[cloth.pins]
corners = ["x-z-", "x+z-"]
)";

Scene too_long() { return parse_scene(kTooLong, "test.toml"); }

TEST(Trouble, StopsInTheFrameAndSaysInWhichSubstep) {
    Simulation simulation = simulation_of(too_long(), OnTrouble::kStop);
    std::string hash;
    std::string message;
    try {
        while (simulation.frame() < 12) {
            hash = simulation.hash();
            simulation.advance();
        }
    } catch (const RunError& error) {
        message = error.what();
    }
    const std::string frame = std::to_string(simulation.frame());
    EXPECT_LT(simulation.frame(), 12);
    EXPECT_NE(message.find("frame " + frame + ", substep 0: energy from nowhere"),
              std::string::npos)
        << message;
    EXPECT_EQ(simulation.hash(), hash) << "the state is that of the frame's start";
}

TEST(Trouble, IsReportedAndGoneOnWith) {
    Simulation simulation = simulation_of(too_long(), OnTrouble::kReport);
    while (simulation.frame() < 12) simulation.advance();
    ASSERT_FALSE(simulation.troubles().empty());
    EXPECT_NE(simulation.troubles()[0].what.find("energy from nowhere"), std::string::npos);

    Simulation stopped = simulation_of(too_long(), OnTrouble::kStop);
    EXPECT_THROW(while (stopped.frame() < 12) stopped.advance(), RunError);
    EXPECT_LE(simulation.troubles()[0].frame, stopped.frame());
}

/// Pins that all go one way are no excuse: what they do is known.
TEST(Trouble, IsSeenWherePinsMoveTogether) {
    Scene scene = parse_scene(kTooLong + R"(
[cloth.pins.motion]
velocity = [2.0, 0.0, 1.0]
)",
                              "test.toml");
    Simulation simulation = simulation_of(scene, OnTrouble::kReport);
    while (simulation.frame() < 12) simulation.advance();
    ASSERT_FALSE(simulation.troubles().empty());
    EXPECT_NE(simulation.troubles()[0].what.find("energy from nowhere"), std::string::npos);
}

struct Halved {
    std::string hash;
    double strain = 0.0;
    std::uint32_t substeps = 0;
};

Halved run_halving(const std::string& devices, int frames = 12) {
    Simulation simulation = simulation_of(too_long(), OnTrouble::kHalve, devices);
    FrameRecord frame;
    while (simulation.frame() < frames) frame = simulation.advance();
    EXPECT_FALSE(simulation.troubles().empty());
    EXPECT_NE(simulation.troubles()[0].what.find("with 2 substeps"), std::string::npos);
    return {simulation.hash(), frame.strain_rms, frame.substeps};
}

TEST(Trouble, IsMendedBySmallerStepsWithTheSameBitsOnEveryDevice) {
    Simulation reporting = simulation_of(too_long(), OnTrouble::kReport);
    FrameRecord last;
    while (reporting.frame() < 12) last = reporting.advance();

    const Halved halved = run_halving("cpu/1");
    EXPECT_GT(halved.substeps, 1U);
    EXPECT_LE(halved.substeps, 16U);
    EXPECT_LT(halved.strain, 0.5 * last.strain_rms);
    EXPECT_EQ(run_halving("cpu/2").hash, halved.hash);
    if (opencl_devices().empty()) return;
    EXPECT_EQ(run_halving("opencl:0/1").hash, halved.hash);
    EXPECT_EQ(run_halving("cpu/1+opencl:0/1").hash, halved.hash);
}

/// So stiff that 16 times the substeps are too few for one iteration.
TEST(Trouble, ThatSmallerStepsDoNotMendIsToldWithTheirNumber) {
    Scene scene = too_long();
    scene.cloths[0].stretch.stiffness = 1e9;
    scene.solver.iterations = 1;
    scene.frames = 20;
    Simulation simulation = simulation_of(scene, OnTrouble::kHalve);
    std::string all;
    try {
        while (simulation.frame() < 20) simulation.advance();
    } catch (const RunError& error) {
        all = error.what();
    }
    for (const Trouble& trouble : simulation.troubles()) all += trouble.what + '\n';
    EXPECT_NE(all.find("--on-trouble halve has given up, with 16 substeps, 16 times as many"),
              std::string::npos)
        << all;
}

TEST(Trouble, ARunGoesOnFromItsCheckpointWithItsSmallerSteps) {
    const std::string whole = run_halving("cpu/1").hash;
    Simulation first = simulation_of(too_long(), OnTrouble::kHalve);
    while (first.frame() < 10) first.advance();
    ASSERT_GT(first.model().scene.substeps, 1);

    Simulation second = simulation_of(too_long(), OnTrouble::kHalve);
    second.resume(first.checkpoint());
    EXPECT_EQ(second.model().scene.substeps, first.model().scene.substeps);
    while (second.frame() < 12) second.advance();
    EXPECT_EQ(second.hash(), whole);
}

/// What a run has said by its end.
std::string said_by(const Scene& scene) {
    Simulation simulation = simulation_of(scene, OnTrouble::kReport);
    while (simulation.frame() < scene.frames) simulation.advance();
    std::string all;
    for (const Trouble& trouble : simulation.troubles()) all += trouble.what + '\n';
    return all;
}

struct Strained {
    double most = 0.0;     ///< the largest strain, RMS, of any frame
    bool is_told = false;  ///< by the run, as trouble
};
Strained strained_by(const Scene& scene) {
    Simulation simulation = simulation_of(scene, OnTrouble::kReport);
    Strained run;
    while (simulation.frame() < scene.frames) {
        run.most = std::max(run.most, simulation.advance().strain_rms);
    }
    run.is_told = !simulation.troubles().empty();
    return run;
}

class EveryWrong : public EverySolver {};

/// A sheet of triangles 400 times as long as wide, in steps that few iterations do not solve: where
/// it ends far longer than it was, the run says so. Coordinates are no excuse for that.
TEST_P(EveryWrong, SliversThatGiveWayAreSeen) {
    const Scene scene = scene_of(R"(
[scene]
frames = 30
dt = 0.016666667
substeps = 8
[[cloth]]
grid = { size = [1.0, 0.01], resolution = [6, 9] }
translate = [3.0, 0.0, 0.0]
density = 0.2
membrane = { young = 1.0e6, poisson = 0.3, thickness = 1.0e-3 }
pins = { edges = ["x-"] }
)");
    const Strained run = strained_by(scene);
    const bool gives_way = GetParam() == Method::kXpbd;
    EXPECT_EQ(run.most > 0.1, gives_way) << run.most;
    EXPECT_EQ(run.is_told, gives_way) << run.most;
}

/// A cloth that pins on two sides tear along faster than waves run in it: there is energy for
/// anything, and iterations that do not solve the steps show. (The plane is far away.)
TEST_P(EveryWrong, SupersonicPinsAreNoExcuse) {
    const Scene scene = scene_of(R"(
[scene]
frames = 6
dt = 0.016666667
substeps = 10
[solver]
iterations = 8
[[cloth]]
grid = { size = [1.5, 1.0], resolution = [30, 20] }
rotate = [1.0, 0.0, 0.0, 90.0]
density = 0.15
stretch = { stiffness = 2.0e4 }
pins = { edges = ["x-", "x+"], motion = { velocity = [0.0, 0.0, 300.0] } }
[[obstacle]]
shape = "plane"
point = [0.0, -100.0, 0.0]
)");
    const std::string said = said_by(scene);
    EXPECT_EQ(said.empty(), GetParam() == Method::kNewton) << said;
}

/// What turning pins do is not known, so that nothing can be said of energy. Strain that is plain
/// to see in steps that are not solved is doubted all the same.
TEST_P(EveryWrong, StrainIsDoubtedWhereWorkIsUnknown) {
    Scene scene = scene_of(R"(
[scene]
frames = 40
dt = 0.016666667
substeps = 4
[solver]
iterations = 1
[[solid]]
grid = { size = [0.6, 0.1, 0.1], resolution = [13, 3, 3] }
density = 1000.0
young = 1.0e6
poisson = 0.495
[[solid.pins]]
faces = ["x-"]
[[solid.pins]]
faces = ["x+"]
motion = { angular_velocity = 360.0, axis = [1.0, 0.0, 0.0] }
)");
    const bool gives_way = GetParam() != Method::kXpbd && GetParam() != Method::kNewton;
    if (gives_way) {
        scene.substeps = 1;
        scene.dt = 1.0 / 30;
    }
    const Strained run = strained_by(scene);
    EXPECT_EQ(run.most > 0.3, gives_way) << run.most;
    EXPECT_EQ(run.most > 0.2, gives_way) << run.most;
    // xpbd keeps its edges, but changes volumes: twenty times the energy that there should be.
    EXPECT_EQ(run.is_told, GetParam() != Method::kNewton) << run.most;
}

/// The same of cloth that is torn around faster than waves run in it.
TEST_P(EveryWrong, StretchIsDoubtedThatASolvedStepWouldNotLeave) {
    const Scene scene = scene_of(R"(
[scene]
frames = 15
dt = 0.016666667
substeps = 10
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [14, 14] }
density = 0.2
stretch = { stiffness = 1.0e5 }
[cloth.pins]
edges = ["x-"]
motion = { angular_velocity = 20000.0, center = [-0.5, 0.0, 0.0] }
)");
    const bool gives_way = GetParam() != Method::kNewton;
    const Strained run = strained_by(scene);
    EXPECT_EQ(run.most > 0.1, gives_way) << run.most;
    EXPECT_LT(run.most, 0.3);
    EXPECT_EQ(run.is_told, gives_way) << run.most;
}

/// A beam of which solved steps let no more than 2 mm go, and others 10 cm: at 2 % of strain.
TEST_P(EveryWrong, ABeamThatSagsIsSeen) {
    const Scene scene = scene_of(R"(
[scene]
frames = 30
dt = 0.016666667
substeps = 4
[[solid]]
grid = { size = [1.0, 0.1, 0.1], resolution = [9, 3, 3] }
density = 1000.0
young = 1.0e8
poisson = 0.3
pins = { faces = ["x-"] }
)");
    const bool gives_way = GetParam() == Method::kXpbd;
    const Strained run = strained_by(scene);
    EXPECT_EQ(run.most > 0.005, gives_way) << run.most;
    EXPECT_LT(run.most, 0.02);
    EXPECT_EQ(run.is_told, gives_way) << run.most;
}

/// A block that is pulled, and as long as it is pulled: by xpbd as by the others, though its steps
/// have a relative error of 1.
TEST_P(EveryWrong, NothingIsSaidOfWhatIsPulled) {
    const Scene scene = scene_of(R"(
[scene]
frames = 30
dt = 0.016666667
substeps = 4
[[solid]]
grid = { size = [0.6, 0.2, 0.2], resolution = [7, 3, 3] }
density = 1000.0
young = 1.0e6
poisson = 0.4
[[solid.pins]]
faces = ["x-"]
[[solid.pins]]
faces = ["x+"]
motion = { velocity = [0.5, 0.0, 0.0] }
)");
    const Strained run = strained_by(scene);
    EXPECT_NEAR(run.most, 0.23, 0.01) << "the scene is a case";
    EXPECT_FALSE(run.is_told);
}

/// What is soft and stretched far, in steps that are solved, is left alone.
TEST_P(EveryWrong, NothingIsSaidOfRubber) {
    const Scene scene = scene_of(R"(
[scene]
frames = 40
dt = 0.016666667
substeps = 20
[solver]
iterations = 20
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [9, 9] }
rotate = [1.0, 0.0, 0.0, 90.0]
density = 0.2
stretch = { stiffness = 3.0 }
pins = { edges = ["z-"] }
)");
    const Strained run = strained_by(scene);
    EXPECT_GT(run.most, 0.25) << "the scene is a case";
    EXPECT_FALSE(run.is_told);
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryWrong, kMethods, name_of_method);

}  // namespace
}  // namespace weft::test
