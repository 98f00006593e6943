// Edges that are sewn together.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "runtime/error.h"
#include "simulation/families/convert.h"
#include "simulation/families/stitches/stitches.h"
#include "simulation/reference/incremental_potential.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "simulation/state/diagnostics.h"
#include "tests/simulation/run/one_plan.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

/// Two panels side by side, a hand apart; the right one is cut more finely.
const std::string kPanels = R"(
[scene]
frames = 60
dt = 0.016666667
substeps = 4
gravity = [0.0, 0.0, 0.0]
[solver]
iterations = 10
[[cloth]]
name = "left"
grid = { size = [0.3, 0.4], resolution = [10, 13] }
translate = [-0.2, 0.0, 0.0]
density = 0.2
stretch = { stiffness = 1.0e3 }
damping = 2.0
[[cloth]]
name = "right"
grid = { size = [0.3, 0.4], resolution = [10, 17] }
rotate = [0.0, 1.0, 0.0, 180.0]
translate = [0.2, 0.0, 0.0]
density = 0.2
stretch = { stiffness = 1.0e3 }
damping = 2.0
[[seam]]
a = { cloth = "left", edges = ["x+"] }
b = { cloth = "right", edges = ["x+"] }
stiffness = 1.0e3
time = 0.5
)";

/// The longest stitch now [m].
double widest(const ManualRun& run) {
    const Stitches& stitches = *run.model->find<Stitches>();
    double most = 0.0;
    for (int s = 0; s < stitches.count(); ++s) {
        const auto ends = stitches.corners(s);
        const auto at = [&](int end) {
            return to_vec3((*run.model->positions)[static_cast<std::size_t>(end)]);
        };
        most = std::max(most, length(at(ends[0]) - at(ends[1])));
    }
    return most;
}

Scene sewn(const std::string& text, Method method) {
    Scene scene = parse_scene(text, "test.toml");
    scene.solver.method = method;
    return scene;
}

class Sewing : public EverySolver {};

TEST_P(Sewing, PanelsAreTogetherWhenTheSeamIsClosed) {
    ManualRun run(sewn(kPanels, GetParam()));
    // Of edges cut differently, a vertex of the coarser one has up to two stitches.
    const double start = widest(run);
    ASSERT_GT(start, 0.099);
    run.run(15);
    EXPECT_NEAR(widest(run), 0.5 * start, 0.25 * start) << "half of the time";
    run.run(45);
    EXPECT_LT(widest(run), 0.02) << "what lies between vertices of both";
    run.run(60);
    EXPECT_LT(widest(run), 0.02) << "and stays";
}

TEST_P(Sewing, VerticesThatFitCloseWithoutAGap) {
    Scene scene = sewn(kPanels, GetParam());
    scene.cloths[1].shape = scene.cloths[0].shape;
    ManualRun run(scene);
    EXPECT_EQ(run.model->find<Stitches>()->count(), 13);
    run.run(90);
    EXPECT_LT(widest(run), 1e-3);
}

/// Stitches pull at both ends alike: this holds to rounding.
TEST(Stitches, LeaveMomentumAtZero) {
    ManualRun run(parse_scene(kPanels, "test.toml"));
    run.run(15);
    Vec3 sum;
    double size = 0.0;
    for (std::size_t v = 0; v < run.model->positions->count(); ++v) {
        const Vec3 p = run.model->masses[v] * to_vec3((*run.model->velocities)[v]);
        sum = sum + p;
        size += length(p);
    }
    EXPECT_GT(size, 1e-3) << "it moves";
    EXPECT_LT(length(sum), 1e-4 * size);
}

/// Stitches along two edges, from the first end of a to its last.
std::vector<std::array<int, 2>> stitches_of(const Scene& scene) {
    Warnings warnings;
    const Model model(scene, warnings);
    const Stitches& stitches = *model.find<Stitches>();
    std::set<std::array<int, 2>> pairs;
    for (int s = 0; s < stitches.count(); ++s) {
        const auto ends = stitches.corners(s);
        std::array<int, 2> pair{model.strips.order[static_cast<std::size_t>(ends[0])],
                                model.strips.order[static_cast<std::size_t>(ends[1])]};
        std::sort(pair.begin(), pair.end());
        pairs.insert(pair);
    }
    return {pairs.begin(), pairs.end()};
}

TEST(Stitches, OfEqualEdgesJoinVertexToVertexTheNearWay) {
    Scene scene = parse_scene(kPanels, "test.toml");
    scene.cloths[1].shape = scene.cloths[0].shape;
    // The right panel is turned by half a turn: its edge runs the other way.
    std::vector<std::array<int, 2>> expected;
    for (int k = 0; k < 13; ++k) expected.push_back({10 * k + 9, 130 + 10 * (12 - k) + 9});
    EXPECT_EQ(stitches_of(scene), expected);
}

TEST(Stitches, OfLoopsBeginWhereTheyAreNearest) {
    Scene scene = parse_scene(kPanels, "test.toml");
    for (const std::size_t c : {0U, 1U}) {
        scene.cloths[c].shape = CylinderShape{{0.1, 0.1}, 0.2, {12, 4}};
        scene.cloths[c].transform = {};
    }
    scene.cloths[1].transform.rotations = {{{0.0, 1.0, 0.0}, 90.0}};
    scene.cloths[1].transform.translate = {0.0, -0.3, 0.0};
    scene.seams[0].a.selected = {};
    scene.seams[0].a.selected.rims = {"bottom"};
    scene.seams[0].b.selected = {};
    scene.seams[0].b.selected.rims = {"top"};
    Warnings warnings;
    const Model model(scene, warnings);
    const Stitches& stitches = *model.find<Stitches>();
    EXPECT_EQ(stitches.count(), 12);
    for (int s = 0; s < stitches.count(); ++s) EXPECT_NEAR(stitches.start(s), 0.1, 1e-6);
}

/// E = k/2 (d - d (1 - t / 0.5))^2 at the end of the first substep.
TEST(Stitches, ReferenceKnowsHowFarTheyAreClosed) {
    Warnings warnings;
    const Scene scene = parse_scene(kPanels, "test.toml");
    Model model(scene, warnings);
    const Stitches& stitches = *model.find<Stitches>();
    for (const double time : {0.0, 0.2, 0.6}) {
        const IncrementalPotential potential(model, time);
        const double part = std::min((time + scene.dt / scene.substeps) / 0.5, 1.0);
        double expected = 0.0;
        for (int s = 0; s < stitches.count(); ++s) {
            expected += 0.5 * 1.0e3 * part * part * stitches.start(s) * stitches.start(s);
        }
        EXPECT_NEAR(stitches.total_energy(model.positions->span()), expected, 1e-5 * expected);
    }
}

/// E = k/2 (d - d (1 - t / 0.5))^2 at the end of the frame, not of its first substep.
TEST(Stitches, EnergyOfAFrameIsThatAtItsEnd) {
    Scene scene = parse_scene(kPanels, "test.toml");
    for (Cloth& cloth : scene.cloths) {
        cloth.pins.emplace_back().boxes = {Box3{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}}};
    }
    Simulation simulation = simulation_of(scene);
    const Stitches& stitches = *simulation.model().find<Stitches>();
    double open = 0.0;
    for (int s = 0; s < stitches.count(); ++s) {
        open += 0.5 * 1.0e3 * stitches.start(s) * stitches.start(s);
    }
    const auto names = energy_names(simulation.model());
    const auto part = std::ranges::find(names, "stitch") - names.begin();
    while (simulation.frame() < 40) {
        const double closed = std::min(simulation.time() / 0.5, 1.0);
        EXPECT_NEAR(simulation.energies().parts()[static_cast<std::size_t>(part)],
                    open * closed * closed, 1e-5 * open)
            << simulation.frame();
        simulation.advance();
    }
}

/// A weak seam is closed long before its edges are together, and what it has stored moves them.
TEST_P(Sewing, WhatAClosedSeamHasStoredIsNotFromNowhere) {
    Scene scene = sewn(kPanels, GetParam());
    scene.seams[0].stiffness = 1.0;
    scene.seams[0].time = scene.dt;
    Simulation simulation = simulation_of(scene, OnTrouble::kReport);
    while (simulation.frame() < 20) simulation.advance();
    EXPECT_TRUE(simulation.troubles().empty()) << simulation.troubles()[0].what;
}

TEST(Stitches, OfListedVerticesJoinThemOneByOne) {
    Scene scene = parse_scene(kPanels, "test.toml");
    scene.seams[0].a.selected = {};
    scene.seams[0].a.selected.vertices = {5, 3, 5};
    scene.seams[0].b.selected = {};
    scene.seams[0].b.selected.vertices = {0, 7, 9};
    EXPECT_EQ(stitches_of(scene), (std::vector<std::array<int, 2>>{{3, 137}, {5, 130}, {5, 139}}));
}

std::string refusal(const std::string& from, const std::string& to) {
    std::string text = kPanels;
    text.replace(text.find(from), from.size(), to);
    try {
        Warnings warnings;
        const Model model(parse_scene(text, "s.toml"), warnings);
    } catch (const UserError& error) {
        return error.what();
    }
    return "no error";
}

TEST(Stitches, WhatIsNoEdgeIsExplained) {
    const std::string a = R"(a = { cloth = "left", edges = ["x+"] })";
    EXPECT_NE(refusal(a, R"(a = { cloth = "lefd", edges = ["x+"] })").find("did you mean 'left'?"),
              std::string::npos);
    EXPECT_NE(refusal(a, R"(a = { cloth = "left" })").find("say which of its vertices"),
              std::string::npos);
    EXPECT_NE(refusal(a, R"(a = { cloth = "left", edges = ["x+", "x-"] })")
                  .find("the selection has 2 pieces of the cloth's border; select one"),
              std::string::npos);
    EXPECT_NE(refusal(a, R"(a = { cloth = "left", corners = ["x-z-"] })")
                  .find("the selection has no edge of the cloth's border"),
              std::string::npos);
    EXPECT_NE(refusal(a, R"(a = { cloth = "left", edges = ["x-", "x+", "z-", "z+"] })")
                  .find("edge a of the seam is a closed loop"),
              std::string::npos);
    EXPECT_NE(
        refusal(a, R"(a = { cloth = "left", vertices = [1, 2] })").find("joins them one by one"),
        std::string::npos);
    EXPECT_NE(refusal("time = 0.5", "time = 0.0").find("seam[0].time = 0: must be at least"),
              std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Methods, Sewing, kMethods, name_of_method);

}  // namespace
}  // namespace weft::test
