// Nothing passes an obstacle between two substeps, however fast the one or the other is.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulation/families/convert.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "tests/simulation/run/one_plan.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

const std::string kSheet = R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 4
[solver]
iterations = 8
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [20, 20] }
density = 0.2
stretch = { stiffness = 1.0e3 }
)";

const std::string kBall = R"(
[[obstacle]]
name = "ball"
shape = "sphere"
center = [0.0, 6.0, 0.0]
radius = 0.3
motion = { velocity = [0.0, -1000.0, 0.0] }
)";

// Too fast for the sheet's contact: each vertex waits for its neighbours.
const std::string kFastBall = R"(
[contact]
[[obstacle]]
name = "fast"
shape = "sphere"
center = [0.0, 0.5, 0.0]
radius = 0.2
motion = { velocity = [0.0, -80.0, 0.0] }
)";
const std::string kFastBar = R"(
[contact]
[[obstacle]]
name = "fast"
shape = "capsule"
start = [-0.1, 0.4, 0.0]
end = [0.1, 0.4, 0.1]
radius = 0.05
motion = { velocity = [0.0, -80.0, 0.0] }
)";

const std::string kPlate = R"(
[[obstacle]]
shape = "box"
center = [0.0, -0.6, 0.0]
size = [4.0, 0.002, 4.0]
)";

const std::string kWalls = R"(
damping = 100000.0
[[obstacle]]
shape = "box"
center = [0.8, 0.0, 0.0]
size = [0.04, 4.0, 4.0]
[[obstacle]]
shape = "box"
center = [-0.8, 0.0, 0.0]
size = [0.04, 4.0, 4.0]
)";

/// The sheet, three metres too long, has snapped back for one frame.
struct Snapped {
    std::vector<float> start, end;
    double fastest;  ///< at its end [m per substep]

    explicit Snapped(const ManualRun& run, const std::vector<float>& from)
        : start(from), end(positions(run)), fastest(0.0) {
        for (const float4& v : run.model->velocities->span()) {
            fastest = std::max(fastest, length(to_vec3(v)) * run.model->h);
        }
    }
    /// How many vertices were outside of the walls, and are between them.
    int passed() const {
        int count = 0;
        for (std::size_t k = 0; k < start.size(); k += 3) {
            count += std::abs(start[k]) > 0.82f && std::abs(end[k]) < 0.78f ? 1 : 0;
        }
        return count;
    }
};

class Tunnelling : public EverySolver {
protected:
    static Snapped snap_back(const std::string& obstacles) {
        Scene scene = scene_of(kSheet + obstacles);
        scene.gravity = {};
        scene.substeps = 16;
        scene.solver.iterations = 60;
        ManualRun run(scene);
        auto& x = *run.model->positions;
        for (float4& row : x.span()) row.x *= 4.0f;
        run.changed(x);
        const auto start = positions(run);
        run.run(1);
        return Snapped(run, start);
    }
};

struct OneFrame {
    std::vector<std::string> told;  ///< of vertices that an obstacle has come through
    int behind = 0;                 ///< of the sheet's middle: vertices behind the ball
};

OneFrame one_frame_of(const Scene& scene, OnTrouble on_trouble) {
    Simulation simulation = simulation_of(scene, on_trouble);
    const std::vector<float> start = simulation.positions();
    simulation.advance();
    const std::vector<float> end = simulation.positions();
    OneFrame frame;
    for (int v = 0; v < simulation.model().vertex_count(); ++v) {
        const bool is_middle = length(at(start, v)) < 0.1;
        frame.behind += is_middle && at(end, v).y > 0.5 - 80.0 * scene.dt ? 1 : 0;
    }
    for (const Trouble& trouble : simulation.troubles()) {
        if (trouble.what.find("obstacle 'fast' has come") != std::string::npos) {
            frame.told.push_back(trouble.what);
        }
    }
    return frame;
}

/// The least distance from the origin on the straight way between two points.
double least_distance(Vec3 a, Vec3 b) {
    const Vec3 way = b - a;
    const double part =
        dot(way, way) > 0.0 ? std::clamp(-dot(a, way) / dot(way, way), 0.0, 1.0) : 0;
    return length(a + part * way);
}

TEST_P(Tunnelling, SphereAt1000MetresPerSecondFliesThroughNoVertex) {
    Scene scene = scene_of(kSheet + kBall);
    scene.dt /= 4.0;
    scene.substeps = 1;
    const auto centre = [&](int frame) { return Vec3{0.0, 6.0 - 1000.0 * scene.dt * frame, 0.0}; };
    ManualRun run(scene);
    auto before = positions(run);
    double fastest = 0.0;
    for (int frame = 0; frame < 8; ++frame) {
        run.run(1);
        const auto now = positions(run);
        for (int v = 0; v < run.model->vertex_count(); ++v) {
            ASSERT_GT(least_distance(at(before, v) - centre(frame), at(now, v) - centre(frame + 1)),
                      0.3 - 1e-3)
                << "vertex " << v << " in step " << frame;
            fastest = std::max(fastest, length(at(velocities(run), v)));
        }
        before = now;
    }
    EXPECT_GT(fastest, 499.0) << "it was hit";
}

TEST_P(Tunnelling, WhatAnObstacleComesThroughIsTold) {
    const OneFrame frame = one_frame_of(scene_of(kSheet + kFastBall), OnTrouble::kReport);
    EXPECT_GT(frame.behind, 5) << "nothing to be seen here";
    ASSERT_EQ(frame.told.size(), 1U);
    EXPECT_NE(frame.told.front().find(" of 400 vertices of cloth 'cloth0' (the first: "),
              std::string::npos)
        << frame.told.front();
    EXPECT_NE(frame.told.front().find(" substeps would do"), std::string::npos);
}

TEST_P(Tunnelling, NothingIsToldOfObstaclesThatCarryWhatTheyMeet) {
    Scene scene = scene_of(kSheet + kFastBall);
    scene.substeps = 80;
    const OneFrame frame = one_frame_of(scene, OnTrouble::kReport);
    EXPECT_EQ(frame.told, std::vector<std::string>{});
}

/// Steps in which strain says nothing yet.
TEST_P(Tunnelling, WhatAnObstacleComesThroughIsDoneAgainWithSmallerSteps) {
    Scene scene = scene_of(kSheet + kFastBar);
    scene.substeps = 7;
    const OneFrame frame = one_frame_of(scene, OnTrouble::kHalve);
    ASSERT_EQ(frame.told.size(), 1U);
    EXPECT_NE(frame.told.front().find("done again, and all that follows, with 14 substeps"),
              std::string::npos)
        << frame.told.front();
}

TEST_P(Tunnelling, ThinPlateStopsWhatFallsAt100MetresPerSecond) {
    ManualRun run(scene_of(kSheet + kPlate));
    for (float4& v : run.model->velocities->span()) v.y = -100.0f;
    run.changed(*run.model->velocities);
    for (int frame = 0; frame < 4; ++frame) {
        run.run(1);
        for (const float4& x : run.model->positions->span()) ASSERT_GT(x.y, -0.6f);
    }
}

/// Neither the frame's start says that anything will be fast, nor its end that it was.
TEST_P(Tunnelling, WhatIsFastOnlyWithinAFrameIsStopped) {
    EXPECT_GT(snap_back("damping = 100000.0").passed(), 100) << "nothing to be seen here";
    const Snapped snapped = snap_back(kWalls);
    EXPECT_EQ(snapped.passed(), 0);
    EXPECT_LT(2.0 * snapped.fastest, 0.5 * 0.02) << "its end would have said so";
}

/// What is slower is not swept: it needs no more than where it is.
TEST(SweptObstacles, AreSweptFromAQuarterOfTheirWidthOn) {
    const auto swept_from = [](const std::string& obstacle, double thickness, double speed) {
        Scene scene = parse_scene(kSheet + obstacle, "test.toml");
        scene.obstacles[0].thickness = thickness;
        if (scene.obstacles[0].motion) scene.obstacles[0].motion->velocity = {0.0, -speed, 0.0};
        Warnings warnings;
        Model model(scene, warnings);
        model.place(0.0);
        return std::sqrt(static_cast<double>(model.obstacles->placements()[7].z));
    };
    const std::string plane = "[[obstacle]]\nshape = \"plane\"\npoint = [0.0, -1.0, 0.0]\n";
    EXPECT_NEAR(swept_from(kPlate, 0.01, 0.0), 0.0005 + 0.01, 1e-7);
    EXPECT_NEAR(swept_from(kBall, 0.01, 5.0), 0.15 + 0.01 - 5.0 / 240.0, 1e-6);
    EXPECT_EQ(swept_from(kBall, 0.01, 50.0), 0.0) << "what is at rest may be passed";
    EXPECT_GT(swept_from(plane, 0.01, 0.0), 1e15) << "of a plane nothing is passed";
}

INSTANTIATE_TEST_SUITE_P(Methods, Tunnelling, kMethods, name_of_method);

Warnings warnings_of(const std::string& text) {
    Warnings warnings;
    SimulationOptions options;
    options.devices = "cpu/1";
    options.calibrate = false;
    Simulation simulation(parse_scene(text, "test.toml"), options, warnings);
    return warnings;
}

TEST(StartChecks, SayWhatStartsInsideAnObstacle) {
    const std::string sphere = R"(
[[obstacle]]
name = "ball"
shape = "sphere"
center = [0.0, -0.1, 0.0]
radius = RADIUS
)";
    const auto with_radius = [&](const char* radius) {
        std::string text = kSheet + sphere;
        return warnings_of(text.replace(text.find("RADIUS"), 6, radius));
    };
    EXPECT_TRUE(with_radius("0.1").empty()) << "touching is not inside";
    const Warnings warnings = with_radius("0.12");
    ASSERT_EQ(warnings.size(), 1U);
    // Vertices are at odd multiples of 1/38 m: four are within sqrt(0.12^2 - 0.1^2) = 0.066 m. They
    // are 0.12 - hypot(0.1, sqrt(2) / 38) = 0.0133 m deep, a substep is 4.17 ms.
    EXPECT_TRUE(
        warnings[0].starts_with("4 of 400 vertices of cloth 'cloth0' start inside obstacle "
                                "'ball' (the first: 189, 190, 209), up to 0.0133 m deep"))
        << warnings[0];
}

TEST(StartChecks, SayWhichObstacleTurnsTooFast) {
    const std::string fan = R"(
[[obstacle]]
name = "fan"
shape = "box"
center = [0.0, -2.0, 0.0]
size = [1.0, 0.1, 0.1]
motion.keyframes = [
    { time = 0.0 }, { time = 0.1, rotate = 10.0 }, { time = 0.2, rotate = SPEED }
]
)";
    const auto with_turn = [&](const char* speed) {
        std::string text = kSheet + fan;
        return warnings_of(text.replace(text.find("SPEED"), 5, speed));
    };
    EXPECT_TRUE(with_turn("1000.0").empty());
    const Warnings warnings = with_turn("2170.0");  // 21600 degrees/s: 90 in a substep
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_TRUE(
        warnings[0].starts_with("obstacle 'fan' turns by 90 degrees in one substep of "
                                "frame 5"))
        << warnings[0];
    EXPECT_TRUE(warnings[0].ends_with("it takes 8 substeps")) << warnings[0];
}

}  // namespace
}  // namespace weft::test
