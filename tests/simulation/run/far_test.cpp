// Scenes far from the origin: what happens there is what happens near it, to the bit where the way
// there can be written exactly.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>

#include "simulation/cloth_scene.h"
#include "simulation/reference/fine_run.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "simulation/state/diagnostics.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

/// A scene's text with every place in it, written @[x, y, z], moved.
std::string moved(const std::string& text, Vec3 by) {
    static const std::regex place(R"(@\[([^,\]]+),([^,\]]+),([^,\]]+)\])");
    std::string moved;
    std::string::const_iterator rest = text.begin();
    for (std::sregex_iterator hit(text.begin(), text.end(), place), end; hit != end; ++hit) {
        const auto number = [&](std::size_t k) { return std::stod((*hit)[k].str()); };
        moved.append(rest, (*hit)[0].first);
        moved += fmt::format("[{}, {}, {}]", number(1) + by.x, number(2) + by.y, number(3) + by.z);
        rest = (*hit)[0].second;
    }
    return moved.append(rest, text.end());
}

constexpr const char* kHead = R"(
[scene]
frames = 12
dt = 0.015625
substeps = 8
gravity_keyframes = [[0.0, 0.0, -9.75, 0.0], [0.25, 4.0, -9.75, 0.0]]
[solver]
iterations = 4
)";

/// A sheet led by pins that turn, and a brick tied to it, among obstacles of every convex shape,
/// some of which move, turn, or are carried by others.
const std::string kAmongObstacles = std::string(kHead) + R"(
[[cloth]]
name = "sheet"
grid = { size = [1.0, 1.0], resolution = [9, 9] }
translate = @[0.0, 0.5, 0.0]
density = 0.25
stretch = { stiffness = 1.0e3 }
bend = { stiffness = 1.0e-3 }
damping = 0.5
[[cloth.pins]]
box = [@[-0.55, 0.25, -0.55], @[-0.3, 0.75, -0.2]]
motion = { angular_velocity = 90.0, axis = [0.0, 1.0, 0.0], center = @[-0.5, 0.5, -0.5] }
[[solid]]
name = "brick"
grid = { size = [0.25, 0.125, 0.25], resolution = [3, 3, 3] }
translate = @[0.0, 0.4375, 0.0]
density = 100.0
young = 1.0e4
poisson = 0.3
[[attachment]]
a = "brick"
b = "sheet"
box = [@[-0.15, 0.45, -0.15], @[0.15, 0.55, 0.15]]
stiffness = 100.0
[[obstacle]]
shape = "plane"
point = @[0.0, 0.0, 0.0]
normal = [0.0, 1.0, 0.25]
friction = 0.25
[[obstacle]]
shape = "sphere"
center = @[0.25, 0.25, 0.25]
radius = 0.1875
friction = 0.25
motion = { velocity = [0.0, 0.5, 0.0] }
[[obstacle]]
name = "box"
shape = "box"
center = @[-0.25, 0.375, 0.25]
size = [0.25, 0.125, 0.25]
rotate = [0.0, 0.0, 1.0, 20.0]
motion = { angular_velocity = 60.0, axis = [0.0, 0.0, 1.0], center = @[-0.25, 0.25, 0.25] }
[[obstacle]]
shape = "capsule"
start = @[0.25, 0.375, -0.5]
end = @[0.25, 0.375, 0.0]
radius = 0.0625
parent = "box"
)";

/// Two sheets and a tray that moves and turns, which touch each other.
const std::string kTouching = std::string(kHead) + R"(
[contact]
friction = 0.25
[[cloth]]
name = "low"
grid = { size = [0.5, 0.5], resolution = [9, 9] }
translate = @[0.0, 0.25, 0.0]
density = 0.25
stretch = { stiffness = 1.0e3 }
[[cloth]]
name = "high"
grid = { size = [0.5, 0.5], resolution = [5, 5] }
translate = @[0.125, 0.28125, 0.125]
density = 0.25
stretch = { stiffness = 1.0e3 }
[[obstacle]]
name = "tray"
shape = "mesh"
grid = { size = [0.375, 0.375], resolution = [4, 4] }
translate = @[0.0, 0.1875, 0.0]
[obstacle.motion]
velocity = [0.0, 0.5, 0.0]
angular_velocity = 90.0
axis = [0.0, 1.0, 0.0]
center = @[0.125, 0.0, 0.0]
)";

/// A sheet that turning pins alone hold: what they do is known exactly.
const std::string kTurned = std::string(kHead) + R"(
[[cloth]]
name = "sheet"
grid = { size = [1.0, 1.0], resolution = [9, 9] }
translate = @[0.0, 0.25, 0.0]
density = 0.25
stretch = { stiffness = 1.0e3 }
[[cloth.pins]]
edges = ["x-"]
motion = { angular_velocity = 90.0, axis = [1.0, 0.0, 0.0], center = @[0.0, 0.25, 0.0] }
)";

const Vec3 kAway[] = {{1000.0, 0.0, 0.0}, {10000.0, -10000.0, 10000.0}, {0.0, 9e5, 0.0}};

struct State {
    std::vector<float> positions, velocities;  ///< counted from the model's origin
    bool operator==(const State&) const = default;
};

State run(const Scene& scene, Vec3 origin) {
    ManualRun run(scene);
    EXPECT_EQ(run.model->origin, origin);
    const auto start = positions(run);
    run.run(scene.frames);
    EXPECT_GT(difference(start, positions(run)), 0.05);
    return {positions(run), velocities(run)};
}

class Far : public EverySolver {
protected:
    void expect_same_bits(const std::string& text) {
        const State near = run(scene_of(moved(text, {})), {});
        for (const Vec3 by : kAway) {
            const State far = run(scene_of(moved(text, by)), by);
            EXPECT_TRUE(far == near) << by.x << ": " << difference(far.positions, near.positions);
        }
    }
};

TEST_P(Far, ObstaclesPinsAndTiesGiveTheSameBits) { expect_same_bits(kAmongObstacles); }

TEST_P(Far, ContactGivesTheSameBits) { expect_same_bits(kTouching); }

/// Where it cannot be written exactly, or positions count from another place of the bodies, results
/// are off by what rounding does near the origin, too.
TEST_P(Far, AnyPlaceGivesTheSameMotion) {
    const auto motion_at = [&](Vec3 by) {
        ManualRun run(scene_of(moved(kAmongObstacles, by)));
        auto way = positions(run);
        run.run(8);
        const auto end = positions(run);
        for (std::size_t i = 0; i < way.size(); ++i) way[i] = end[i] - way[i];
        return way;
    };
    const auto near = motion_at({});
    EXPECT_LT(difference(motion_at({1234.567, -9876.543, 10000.7}), near), 2e-3);
    EXPECT_LT(difference(motion_at({0.3, -0.7, 0.9}), near), 2e-3);
}

INSTANTIATE_TEST_SUITE_P(Solvers, Far, kMethods, name_of_method);

SimulationOptions on_one_core() {
    SimulationOptions options;
    options.devices = "cpu/1";
    options.calibrate = false;
    return options;
}

/// Frames of a whole run, with all that is told of them.
struct Told {
    std::vector<FrameRecord> frames;
    double mass = 0.0;  ///< of all that is free [kg]
};

Told told(const std::string& text, Method method, Vec3 by) {
    Scene scene = parse_scene(moved(text, by), "test.toml");
    scene.solver.method = method;
    Warnings warnings;
    Simulation simulation(scene, on_one_core(), warnings);
    EXPECT_TRUE(warnings.empty());
    Told told;
    while (simulation.frame() < scene.frames) told.frames.push_back(simulation.advance());
    const Model& model = simulation.model();
    for (std::size_t v = 0; v < model.masses.size(); ++v) {
        if ((*model.positions)[v].w > 0.0f) told.mass += model.masses[v];
    }
    return told;
}

/// Energies are those of the scene's own coordinates, gravity's too, also where it changes; and
/// what is not a matter of place is the same.
TEST(FarRuns, TellTheScenesOwnEnergies) {
    const Vec3 by{10000.0, -10000.0, 10000.0};
    for (const std::string& text : {kAmongObstacles, kTurned}) {
        const Told near = told(text, Method::kVbd, {});
        const Told far = told(text, Method::kVbd, by);
        const Scene scene = parse_scene(moved(text, by), "test.toml");
        ASSERT_EQ(near.frames.size(), far.frames.size());
        const auto lifted = [&](double time) {
            return -near.mass * dot(scene.gravity_at(time), by);
        };
        for (std::size_t f = 0; f < near.frames.size(); ++f) {
            const FrameRecord &a = near.frames[f], &b = far.frames[f];
            EXPECT_EQ(a.kinetic_energy, b.kinetic_energy);
            EXPECT_EQ(a.energies, b.energies);
            EXPECT_EQ(a.strain_rms, b.strain_rms);
            const double offset = lifted(a.sim_time);
            EXPECT_NEAR(b.gravity_energy - a.gravity_energy, offset, 1e-9 * std::abs(offset));
            EXPECT_NEAR(b.work - a.work, offset - lifted(0.0), 1e-9 * std::abs(offset));
            EXPECT_NEAR(b.dissipated, a.dissipated, 1e-8 * std::abs(offset));
        }
        EXPECT_GT(near.frames.back().work, 1e-3);
    }
}

/// So is how far steps are solved, which a model of its own finds out.
TEST(FarRuns, EstimateTheSameErrors) {
    for (const std::string& text : {kAmongObstacles, kTouching}) {
        const double near = told(text, Method::kVbd, {}).frames.back().relative_error;
        EXPECT_GT(near, 0.0);
        EXPECT_EQ(told(text, Method::kVbd, {}).frames.back().relative_error, near);
        EXPECT_EQ(told(text, Method::kVbd, kAway[1]).frames.back().relative_error, near);
    }
}

TEST(FarRuns, FineOnesGiveTheSameBits) {
    const auto fine = [](Vec3 by) {
        Warnings warnings;
        Model model(parse_scene(moved(kAmongObstacles, by), "test.toml"), warnings);
        FineRun run(model, FineRun::stable_substeps(model));
        for (int frame = 0; frame < 4; ++frame) run.advance();
        return run.positions();
    };
    EXPECT_EQ(fine(kAway[1]), fine({}));
}

/// The state as it is kept has all digits, and its hash knows of each, and where it is.
TEST(FarRuns, GoOnFromCheckpointsToTheBit) {
    const Scene scene = parse_scene(moved(kAmongObstacles, kAway[1]), "test.toml");
    Warnings warnings;
    Simulation whole(scene, on_one_core(), warnings);
    Simulation again(scene, on_one_core(), warnings);
    for (int frame = 0; frame < 3; ++frame) whole.advance();
    again.resume(whole.checkpoint());
    EXPECT_EQ(again.hash(), whole.hash());
    for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(again.advance().work, whole.advance().work);
    EXPECT_EQ(again.hash(), whole.hash());
    const Simulation near(parse_scene(moved(kAmongObstacles, {}), "test.toml"), on_one_core(),
                          warnings);
    EXPECT_EQ(Simulation(scene, on_one_core(), warnings).positions(), near.positions());
    EXPECT_NE(Simulation(scene, on_one_core(), warnings).hash(), near.hash());
}

/// Who uses the library sees the scene's own coordinates, and pushes lose no digits.
TEST(FarRuns, GiveTheLibraryTheScenesCoordinates) {
    const auto scene_at = [](Vec3 by) {
        return ClothScene::from_text(moved(kAmongObstacles, by), "test.toml", {"cpu/1", {}, {}});
    };
    ClothScene near = scene_at({}), far = scene_at(kAway[1]);
    for (ClothScene* scene : {&near, &far}) {
        scene->push(20, 10, {0.0f, 2.0f, 0.0f});
        scene->step();
    }
    EXPECT_EQ(near.velocities(), far.velocities());
    const auto here = near.positions(), there = far.positions();
    const double by[3] = {kAway[1].x, kAway[1].y, kAway[1].z};
    for (std::size_t i = 0; i < here.size(); ++i) {
        EXPECT_EQ(there[i], static_cast<float>(static_cast<double>(here[i]) + by[i % 3]));
    }
    far.set_state(there, far.velocities());
    EXPECT_EQ(far.positions(), there);
}

/// What is not finite is told with the place in the scene's own coordinates.
TEST(FarRuns, NamePlacesOfTheScene) {
    const Scene scene = parse_scene(moved(kTurned, kAway[1]), "test.toml");
    Warnings warnings;
    SimulationOptions options = on_one_core();
    Simulation simulation(scene, options, warnings);
    auto x = simulation.positions();
    x[3 * 40] = std::nanf("");
    simulation.start_from(0, x, simulation.velocities());
    const auto bad = find_non_finite(simulation.model());
    ASSERT_TRUE(bad);
    EXPECT_NE(bad->what.find(", -9999.75, 10000) m is not finite"), std::string::npos) << bad->what;
}

/// Frames of an obstacle come from files, and are placed where it is.
TEST(FarRuns, LedByFilesGiveTheSameBits) {
    const auto folder = std::filesystem::path(testing::TempDir()) / "weft_far_frames";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    for (const int frame : {0, 1, 2}) {
        std::ofstream file(folder / fmt::format("body_{}.obj", frame));
        file << fmt::format("v -1 {0} -1\nv -1 {0} 1\nv 1 {0} -1\nf 1 2 3\n", 0.125 * frame);
    }
    const std::string body = fmt::format(R"(
[[obstacle]]
name = "body"
shape = "mesh"
mesh = "{0}/body_0.obj"
translate = @[0.0, 0.125, 0.0]
motion = {{ frames = "{0}/body_*.obj", frame_time = 0.0625 }}
)",
                                         folder.string());
    std::string text = kTouching.substr(0, kTouching.find("[[obstacle]]")) + body;
    EXPECT_EQ(run(parse_scene(moved(text, kAway[1]), "test.toml"), kAway[1]),
              run(parse_scene(moved(text, {}), "test.toml"), {}));
}

}  // namespace
}  // namespace weft::test
