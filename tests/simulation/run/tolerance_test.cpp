// Iterations until the estimate says that it is enough.

#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "runtime/opencl/opencl_device.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "tests/simulation/run/one_plan.h"
#include "tests/simulation/run/touching_sheets.h"

namespace weft::test {
namespace {

/// A sheet that swings on two corners: first much, later less is to be solved.
Scene swinging(const std::string& solver) {
    return parse_scene(R"(
[scene]
frames = 24
dt = 0.016666667
substeps = 4
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [12, 12] }
density = 0.2
stretch = { stiffness = 1.0e4 }
bend = { stiffness = 1.0e-3 }
pins = { corners = ["x-z-", "x+z-"] }
[solver]
)" + solver,
                       "test.toml");
}

const std::string kReachable = "method = \"vbd\"\niterations = 256\ntolerance = 1.0e-2\n";

TEST(Tolerance, IsKeptWithFewerIterationsThanTheMost) {
    const Scene scene = swinging(kReachable);
    Simulation simulation = simulation_of(scene);
    int estimates = 0;
    std::uint32_t fewest = 256;
    while (simulation.frame() < scene.frames) {
        const FrameRecord frame = simulation.advance();
        fewest = std::min(fewest, frame.iterations);
        EXPECT_LE(frame.iterations, 256U);
        if (!std::isfinite(frame.relative_error)) continue;
        EXPECT_LE(frame.relative_error, 1e-2) << frame.frame;
        ++estimates;
    }
    EXPECT_GE(estimates, 6);
    EXPECT_LT(fewest, 256U);
    EXPECT_TRUE(simulation.troubles().empty());
}

/// Two sheets that press each other.
Scene touching(const std::string& solver) {
    return parse_scene(R"(
[scene]
frames = 12
dt = 0.016666667
substeps = 4
[contact]
thickness = 0.02
friction = 0.3
)" + kTouchingSheets + "[solver]\n" +
                           solver,
                       "test.toml");
}

TEST(Tolerance, IsKeptInContact) {
    Scene scene = touching(kReachable);
    scene.frames = 8;  // behind them, planes stop what swings back
    Simulation simulation = simulation_of(scene);
    int estimates = 0;
    std::uint32_t fewest = 256;
    std::uint32_t most_touching = 0;
    while (simulation.frame() < scene.frames) {
        const FrameRecord frame = simulation.advance();
        fewest = std::min(fewest, frame.iterations);
        most_touching = std::max(most_touching, frame.contacts.front().touching);
        if (!std::isfinite(frame.relative_error)) continue;
        EXPECT_LE(frame.relative_error, 1e-2) << frame.frame;
        ++estimates;
    }
    EXPECT_EQ(estimates, 3);
    EXPECT_LT(fewest, 256U);
    EXPECT_GT(most_touching, 50U);
    EXPECT_TRUE(simulation.troubles().empty());
}

TEST(Tolerance, SaysWhatWouldReachItInContact) {
    Simulation simulation =
        simulation_of(touching("method = \"vbd\"\niterations = 2\ntolerance = 1.0e-3\n"));
    while (simulation.troubles().empty() && simulation.frame() < 12) simulation.advance();
    ASSERT_EQ(simulation.troubles().size(), 1U);
    const std::string& what = simulation.troubles().front().what;
    EXPECT_TRUE(std::regex_search(what, std::regex("[0-9]+ substeps of [0-9]+ iterations")))
        << what;
    EXPECT_NE(what.find("by newton"), std::string::npos) << what;
}

std::string hash_on(const std::string& devices) {
    Simulation simulation = simulation_of(swinging(kReachable), OnTrouble::kStop, devices);
    while (simulation.frame() < 24) simulation.advance();
    return simulation.hash();
}

TEST(Tolerance, GivesTheSameBitsOnEveryDevice) {
    const std::string hash = hash_on("cpu/1");
    EXPECT_EQ(hash_on("cpu/2"), hash);
    if (opencl_devices().empty()) return;
    EXPECT_EQ(hash_on("opencl:0/1"), hash);
    EXPECT_EQ(hash_on("cpu/1+opencl:0/1"), hash);
}

TEST(Tolerance, GoesOnFromACheckpoint) {
    Simulation first = simulation_of(swinging(kReachable));
    const auto iterations = [&] { return first.model().scene.solver.iterations; };
    while (first.frame() < 23 && iterations() == 256) first.advance();
    ASSERT_LT(first.model().scene.solver.iterations, 256);
    Simulation second = simulation_of(swinging(kReachable));
    second.resume(first.checkpoint());
    EXPECT_EQ(second.model().scene.solver.iterations, first.model().scene.solver.iterations);
    while (second.frame() < 24) second.advance();
    EXPECT_EQ(second.hash(), hash_on("cpu/1"));
}

/// The advice holds: a run that takes it is below the tolerance in that frame.
TEST(Tolerance, SaysWhatWouldReachIt) {
    const Scene scene = swinging("method = \"vbd\"\niterations = 4\ntolerance = 0.05\n");
    Simulation simulation = simulation_of(scene);
    while (simulation.troubles().empty() && simulation.frame() < scene.frames) simulation.advance();
    ASSERT_EQ(simulation.troubles().size(), 1U);
    const Trouble& trouble = simulation.troubles().front();
    EXPECT_FALSE(trouble.is_explosion);
    std::smatch found;
    const std::regex advice("([0-9]+) substeps of ([0-9]+) iterations");
    ASSERT_TRUE(std::regex_search(trouble.what, found, advice)) << trouble.what;
    EXPECT_NE(trouble.what.find("by newton"), std::string::npos) << trouble.what;

    Scene followed = swinging("method = \"vbd\"\niterations = " + found[2].str());
    followed.substeps = std::stoi(found[1]);
    followed.frames = trouble.frame + 1;
    Simulation better = simulation_of(followed);
    FrameRecord frame;
    while (better.frame() < followed.frames) frame = better.advance();
    EXPECT_LT(frame.relative_error, 2.0 * 0.05);

    Simulation resumed = simulation_of(scene);
    resumed.resume(simulation.checkpoint());
    while (simulation.frame() < scene.frames) simulation.advance();
    EXPECT_EQ(simulation.troubles().size(), 1U) << "it is said once";
    while (resumed.frame() < scene.frames) resumed.advance();
    EXPECT_TRUE(resumed.troubles().empty()) << "by whoever goes on, too";
}

}  // namespace
}  // namespace weft::test
