// How far a substep was solved, as runs estimate it, against the minimum that Newton's method finds
// in double precision.

#include "simulation/checks/step_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "simulation/reference/equilibrium.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "simulation/solver/solver.h"
#include "tests/simulation/reference/problems.h"
#include "tests/simulation/run/physics.h"
#include "tests/simulation/run/touching_sheets.h"

namespace weft::test {
namespace {

SimulationOptions on(const std::string& devices) {
    SimulationOptions options;
    options.devices = devices;
    options.calibrate = false;
    return options;
}

Scene one_step(const std::string& text, Method method, int iterations) {
    Scene scene = parse_scene(text, "test.toml");
    scene.solver.method = method;
    scene.solver.iterations = iterations;
    scene.dt /= scene.substeps;
    scene.substeps = 1;
    scene.frames = 1;
    return scene;
}

struct Errors {
    double estimated, measured;
};

Errors errors_of(const Scene& scene) {
    Warnings warnings;
    Simulation simulation(scene, on("cpu/1"), warnings);
    Model model(scene, warnings);
    const FrameRecord frame = simulation.advance();
    IncrementalPotential potential(model, 0.0,
                                   with_corners(simulation.contacts(), model.strips.rank));
    const Minimum minimum = find_equilibrium(potential, potential.predicted());
    EXPECT_LT(minimum.certificate.relative_gap, kSolvedGap);
    EXPECT_EQ(scene.contact.has_value(), !potential.contacts().empty());
    std::vector<Vec3> x(potential.predicted().size());
    model.from_scene_order(simulation.positions(), x);
    const double gained = minimum.start_energy - minimum.energy;
    return {frame.relative_error, (potential.energy(x) - minimum.energy) / gained};
}

class StepErrors : public EverySolver {};

TEST_P(StepErrors, AreWithinAFactorOfThree) {
    for (const std::string& text : {kPinnedSheet, kPinnedBlock, kPinnedWeave}) {
        for (const int iterations : {1, 4, 30}) {
            const Errors errors = errors_of(one_step(text, GetParam(), iterations));
            ASSERT_TRUE(std::isfinite(errors.estimated));
            if (errors.measured < 1e-3) continue;
            EXPECT_LT(errors.estimated, 3.0 * errors.measured) << iterations << text;
            EXPECT_GT(errors.estimated, errors.measured / 3.0) << iterations << text;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, StepErrors, kMethods, name_of_method);

const std::string kSoftBeam = R"(
[scene]
frames = 150
dt = 0.02
substeps = 4
[solver]
method = "newton"
iterations = 5
[[solid]]
grid = { size = [0.6, 0.2, 0.2], resolution = [10, 4, 4] }
density = 1000.0
young = 3.0e5
poisson = 0.4
damping = 8.0
pins = { faces = ["x-"] }
)";

const std::string kHeldSheet = R"(
[scene]
frames = 150
dt = 0.02
substeps = 4
[solver]
method = "newton"
iterations = 5
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [16, 16] }
density = 0.2
stretch = { stiffness = 1.0e3 }
damping = 8.0
pins = { edges = ["x-", "x+", "z-", "z+"] }
)";

/// Of all vertices, up and down.
double way(const std::vector<float>& from, const std::vector<float>& to) {
    double sum = 0.0;
    for (std::size_t k = 1; k < from.size(); k += 3) {
        sum += std::abs(static_cast<double>(to[k]) - static_cast<double>(from[k]));
    }
    return sum;
}

/// Where weight, and what bears some of it, is all that a step leaves undone, that leads to where
/// the body rests: as a run of solved steps does.
TEST(SettledPlaces, AreWhereBodiesRest) {
    for (const std::string& text : {kSoftBeam, kHeldSheet}) {
        const Scene scene = parse_scene(text, "test.toml");
        Warnings warnings;
        Simulation simulation(scene, on("cpu/1"), warnings);
        while (simulation.frame() < 4) simulation.advance();
        const std::vector<float> start = simulation.positions();
        while (simulation.frame() < scene.frames) simulation.advance();
        const std::vector<float> rest = simulation.positions();
        StepError error(scene, 1);
        const std::vector<float> still(start.size());
        const std::vector<float> settled =
            error.settled({start, still, start, 0.0, {}, {}}, 200.0, 0.0);
        EXPECT_GT(way(start, rest), 0.3);
        EXPECT_LT(way(settled, rest), 0.02 * way(start, rest)) << text;
    }
}

/// Two sheets that press each other, the upper one as gravity slides it over the lower one.
Scene touching(const std::string& friction) {
    return parse_scene(R"(
[scene]
frames = 12
dt = 0.02
substeps = 4
gravity = [3.0, -9.0, 0.0]
[contact]
thickness = 0.02
)" + friction + kTouchingSheets,
                       "test.toml");
}
const std::string kRubbing = "friction = 0.4\n";

TEST_P(StepErrors, WithContactsAreWithinAFactorOfThree) {
    for (const std::string& friction : {std::string(), kRubbing}) {
        Scene scene = touching(friction);
        scene.solver.method = GetParam();
        scene.dt /= scene.substeps;
        scene.substeps = scene.frames = 1;
        for (const int iterations : {1, 4, 30}) {
            scene.solver.iterations = iterations;
            const Errors errors = errors_of(scene);
            ASSERT_TRUE(std::isfinite(errors.estimated));
            if (errors.measured < 1e-3) continue;
            EXPECT_LT(errors.estimated, 3.0 * errors.measured) << iterations << friction;
            EXPECT_GT(errors.estimated, errors.measured / 3.0) << iterations << friction;
        }
    }
}

/// The estimate of the last frame.
double last_estimate(const Scene& scene, const std::string& devices) {
    Warnings warnings;
    Simulation simulation(scene, on(devices), warnings);
    FrameRecord frame;
    while (simulation.frame() < scene.frames) frame = simulation.advance();
    return frame.relative_error;
}

Scene everything(int frames, int substeps) {
    Scene scene = parse_scene(kPinnedSheet + R"(
[[obstacle]]
shape = "plane"
point = [0.0, -0.002, 0.0]
friction = 0.2
)",
                              "test.toml");
    scene.frames = frames;
    scene.substeps = substeps;
    scene.dt = 0.01 * substeps;
    scene.solver.method = Method::kVbd;
    return scene;
}

TEST(StepError, IsTheSameOnAllDevices) {
    const double expected = last_estimate(everything(3, 4), "cpu/1");
    EXPECT_GT(expected, 0.0);
    for (const char* devices : {"cpu/2", "cpu/1+cpu/1", "opencl:0/1"}) {
        EXPECT_EQ(last_estimate(everything(3, 4), devices), expected) << devices;
    }
}

TEST(StepError, OfContactsIsTheSameOnAllDevices) {
    Scene scene = touching(kRubbing);
    scene.solver.method = Method::kVbd;
    scene.frames = 3;
    const double expected = last_estimate(scene, "cpu/1");
    EXPECT_GT(expected, 0.0);
    for (const char* devices : {"cpu/2", "cpu/1+cpu/1", "opencl:0/1"}) {
        EXPECT_EQ(last_estimate(scene, devices), expected) << devices;
    }
}

TEST(StepError, IsThatOfAFramesLastSubstep) {
    EXPECT_EQ(last_estimate(everything(2, 3), "cpu/1"), last_estimate(everything(6, 1), "cpu/1"));
}

/// A sheet that lies on the ground has nothing left to gain there, though E has: the ground is in
/// its way.
TEST(StepError, LeavesOutWhatObstaclesDo) {
    Scene scene = parse_scene(R"(
[scene]
frames = 3
dt = 0.01
substeps = 1
[solver]
method = "vbd"
iterations = 60
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [6, 6] }
density = 0.2
stretch = { stiffness = 1.0e3 }
[[obstacle]]
shape = "plane"
point = [0.0, 0.0, 0.0]
)",
                              "test.toml");
    EXPECT_LT(last_estimate(scene, "cpu/1"), 1e-3);
}

TEST(StepError, OfAFreeFallIsNone) {
    Scene scene = one_step(kPinnedBlock, Method::kXpbd, 2);
    for (Cloth& cloth : scene.cloths) cloth.pins.clear();
    for (Solid& solid : scene.solids) solid.pins.clear();
    EXPECT_EQ(last_estimate(scene, "cpu/1"), 0.0);
}

TEST(StepError, HasNoMeaningWhereNumbersHaveNone) {
    const Scene scene = one_step(kPinnedSheet, Method::kXpbd, 2);
    StepError error(scene, 1);
    const std::vector<float> rest(3 * 7 * 8);
    std::vector<float> bad = rest;
    bad[17] = std::nanf("");
    EXPECT_EQ(error.of({rest, rest, bad, 0.0, {}}), std::nullopt);
}

}  // namespace
}  // namespace weft::test
