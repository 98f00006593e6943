// That a run says so where surfaces cross that did not at its start, whatever let them.

#include <gtest/gtest.h>

#include <algorithm>

#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"

namespace weft::test {
namespace {

/// Two sheets, held but for a corner of one: what is led by the scene goes where it is led to.
Scene led_sheets(const std::string& place, const std::string& motion, int frames) {
    const std::string text = R"(
[scene]
frames = )" + std::to_string(frames) +
                             R"(
dt = 0.01
substeps = 4
gravity = [0.0, 0.0, 0.0]
[contact]
thickness = 0.02
[[cloth]]
name = "floor"
grid = { size = [1.0, 1.0], resolution = [6, 6] }
density = 0.2
stretch = { stiffness = 100.0 }
pins = { box = [[-9, -9, -9], [9, 9, 9]] }
[[cloth]]
name = "wall"
grid = { size = [0.5, 0.5], resolution = [5, 5] }
density = 0.2
stretch = { stiffness = 100.0 }
rotate = [0, 0, 1, 90]
)" + place + R"(
[cloth.pins]
box = [[-9, -9, -9], [9, 9, 0.2]]
)" + motion;
    return parse_scene(text, "test.toml");
}

std::vector<Trouble> troubles_of(const Scene& scene, int frames,
                                 OnCrossing on_crossing = OnCrossing::kStop) {
    Warnings warnings;
    SimulationOptions options;
    options.devices = "cpu/1";
    options.calibrate = false;
    options.plan = PlanKind::kSingle;
    options.on_trouble = OnTrouble::kReport;
    options.on_crossing = on_crossing;
    Simulation simulation(scene, options, warnings);
    while (simulation.frame() < frames) simulation.advance();
    return simulation.troubles();
}

/// Which frames' troubles say that triangles cross.
std::vector<int> crossings_told(const std::vector<Trouble>& troubles) {
    std::vector<int> frames;
    for (const Trouble& trouble : troubles) {
        if (trouble.what.find("of triangles cross") != std::string::npos) {
            frames.push_back(trouble.frame);
        }
    }
    return frames;
}

constexpr const char* kAbove = "translate = [0.03, 0.3, 0.01]";
constexpr const char* kDown = "motion.velocity = [0, -1, 0]";

TEST(Crossing, IsToldOnceAfterEightFramesAndTwiceAsMany) {
    const auto troubles = troubles_of(led_sheets(kAbove, kDown, 40), 40);
    EXPECT_EQ(crossings_told(troubles), std::vector{7});
    const auto told = std::ranges::find(troubles, 7, &Trouble::frame);
    EXPECT_NE(told->what.find("cloth 'floor' triangle "), std::string::npos) << told->what;
    EXPECT_NE(told->what.find(" and cloth 'wall' triangle "), std::string::npos) << told->what;
    EXPECT_FALSE(told->is_explosion);
    EXPECT_EQ(
        crossings_told(troubles_of(led_sheets("translate = [0.03, 0.35, 0.01]", kDown, 40), 40)),
        std::vector{15});
}

TEST(Crossing, IsToldAtTheEndOfARun) {
    EXPECT_EQ(
        crossings_told(troubles_of(led_sheets("translate = [0.03, 0.45, 0.01]", kDown, 27), 27)),
        std::vector{26});
}

TEST(Crossing, IsNotToldWhereAllIsApart) {
    const auto troubles = troubles_of(led_sheets(kAbove, "motion.velocity = [0, 1, 0]", 20), 20);
    EXPECT_TRUE(troubles.empty()) << troubles.front().what;
}

TEST(Crossing, IsNotToldAgainOfBodiesThatCrossAtTheStart) {
    const Scene scene = led_sheets("translate = [0.03, 0.1, 0.01]", kDown, 10);
    EXPECT_TRUE(crossings_told(troubles_of(scene, 10, OnCrossing::kWarn)).empty());
}

}  // namespace
}  // namespace weft::test
