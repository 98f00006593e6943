// A state that goes bad ends the run with a message that says where, and is undone.

#include <gtest/gtest.h>

#include "runtime/error.h"
#include "runtime/opencl/opencl_device.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"

namespace weft::test {
namespace {

const std::string kSheet = R"(
[scene]
frames = 10
dt = 0.01
substeps = 4
[solver]
iterations = 2
[[cloth]]
name = "sheet"
grid = { size = [1.0, 1.0], resolution = [12, 30] }
density = 0.2
stretch = { stiffness = 1.0e4 }
damping = 0.1
)";

struct Outcome {
    std::string message;
    int frames_done = 0;
};

/// Runs until it diverges, and checks that the state before is intact.
Outcome run_to_the_end(const Scene& scene, const std::string& devices) {
    Warnings warnings;
    SimulationOptions options;
    options.devices = devices;
    Simulation simulation(scene, options, warnings);
    std::string hash = simulation.hash();
    Outcome outcome;
    try {
        for (int frame = 0; frame < scene.frames; ++frame) {
            simulation.advance();
            ++outcome.frames_done;
            hash = simulation.hash();
        }
    } catch (const RunError& error) {
        outcome.message = error.what();
    }
    EXPECT_EQ(simulation.hash(), hash) << "the state is that of the frame's start";
    EXPECT_EQ(simulation.frame(), outcome.frames_done);
    return outcome;
}

void expect_said(const Outcome& outcome, std::initializer_list<const char*> words) {
    for (const char* word : words) {
        EXPECT_NE(outcome.message.find(word), std::string::npos)
            << "'" << word << "' is not in: " << outcome.message;
    }
}

std::vector<std::string> device_lists() {
    if (opencl_devices().empty()) return {"cpu/1"};
    return {"cpu/1", "opencl:0", "cpu/1+opencl:0/1"};
}

TEST(Divergence, OfPositionsNamesFrameSubstepTaskAndVertex) {
    Scene scene = parse_scene(kSheet, "test.toml");
    // Nothing of this size is a float: from 0.025 s on, in the third substep of frame 2.
    scene.gravity_keys = {{0.0, {0, -9.81, 0}}, {0.025, {0, -9.81, 0}}, {0.025001, {0, -1e300, 0}}};
    for (const std::string& devices : device_lists()) {
        const Outcome outcome = run_to_the_end(scene, devices);
        EXPECT_EQ(outcome.frames_done, 2);
        expect_said(outcome, {"frame 2", "substep 2", "task 'predict'", "iteration 0", "vertex ",
                              "of cloth 'sheet'", "not finite"});
    }
}

TEST(Divergence, BeyondTheGuardsNamesFrameSubstepVertexAndBound) {
    const std::string pulled = kSheet + R"(
[cloth.pins]
corners = ["x-z-", "x+z-"]
motion.keyframes = [{ time = 0.0 }, { time = 0.02 }, { time = 0.03, translate = [0.0, 90.0, 0.0] }]
)";
    const Outcome fast = run_to_the_end(parse_scene(pulled, "test.toml"), "cpu/1");
    EXPECT_EQ(fast.frames_done, 2);
    expect_said(fast,
                {"frame 2", "substep", "vertex ", "of cloth 'sheet'", "guard.max_speed", "1000"});

    const Outcome stretched = run_to_the_end(
        parse_scene(pulled + "\n[guard]\nmax_speed = 1e20\nmax_strain = 0.5\n", "test.toml"),
        "cpu/1");
    expect_said(stretched, {"frame 2", "substep", "vertex ", "guard.max_strain", "0.5"});
}

TEST(Divergence, OfNothingIsNotSeen) {
    EXPECT_EQ(run_to_the_end(parse_scene(kSheet, "test.toml"), "cpu/1").frames_done, 10);
}

}  // namespace
}  // namespace weft::test
