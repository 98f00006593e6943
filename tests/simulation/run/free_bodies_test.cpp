// Bodies that nothing holds: whatever the sweeps left unfinished, their momentum is that of
// physics.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

#include "runtime/tbb/cpu_device.h"
#include "simulation/families/convert.h"
#include "simulation/scene/read_scene.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

/// A tube whose vertices are thrown about on its surface: edges of all lengths, hinges of all
/// stiffnesses, slivers; nothing that an unfinished sweep would leave in balance.
std::string irregular_tube() {
    const int around = 24, along = 20;
    const std::string path =
        (std::filesystem::temp_directory_path() / "weft_irregular_tube.obj").string();
    std::ofstream file(path);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> away(-0.45, 0.45);
    for (int j = 0; j < along; ++j) {
        for (int i = 0; i < around; ++i) {
            const double angle = 2.0 * std::numbers::pi * (i + away(random)) / around;
            file << "v " << 0.1 * std::cos(angle) << ' ' << 0.02 * (j + away(random)) << ' '
                 << 0.1 * std::sin(angle) << '\n';
        }
    }
    for (int j = 0; j + 1 < along; ++j) {
        for (int i = 0; i < around; ++i) {
            const int a = j * around + i + 1, b = j * around + (i + 1) % around + 1;
            file << "f " << a << ' ' << b << ' ' << a + around << '\n';
            file << "f " << b << ' ' << b + around << ' ' << a + around << '\n';
        }
    }
    return path;
}

const std::string kTube = R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 4
gravity = [1.0, -9.81, 0.5]
[solver]
iterations = 8
[[cloth]]
mesh = "TUBE"
translate = [0.3, 2.0, 0.0]
density = 0.2
stretch = { stiffness = 1.0e4 }
bend = { stiffness = 1.0e-4 }
)";

/// A block that a cloth is tied to, and a stray cloth beside them: two free bodies.
const std::string kTied = R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 3
[solver]
iterations = 2
[[cloth]]
name = "sheet"
grid = { size = [0.5, 0.5], resolution = [9, 9] }
translate = [0.0, 0.11, 0.0]
density = 0.2
stretch = { stiffness = 1.0e4 }
bend = { stiffness = 1.0e-3 }
[[cloth]]
name = "stray"
grid = { size = [0.5, 2.0], resolution = [9, 60] }
translate = [2.0, 0.0, 0.0]
density = 0.3
stretch = { stiffness = 1.0e3 }
[[solid]]
name = "block"
grid = { size = [0.2, 0.2, 0.2], resolution = [4, 4, 4] }
density = 500.0
young = 1.0e6
poisson = 0.4
[[attachment]]
a = "sheet"
b = "block"
box = [[-0.2, 0.0, -0.2], [0.2, 1.0, 0.2]]
stiffness = 2.0e3
)";

/// A stiff block on a floor, in steps that many iterations hardly solve.
const std::string kLying = R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 4
[[solid]]
grid = { size = [0.2, 0.1, 0.15], resolution = [6, 4, 5] }
rotate = [0, 1, 0, 17]
translate = [0.0, 0.052, 0.0]
density = 300.0
young = 2.0e6
poisson = 0.3
[[obstacle]]
shape = "plane"
point = [0.0, 0.0, 0.0]
friction = 0.5
thickness = 0.002
)";

/// A tall block on a slope of 8 degrees, where it would fall over from 14 degrees on.
const std::string kTall = R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 8
gravity = [1.3653, -9.7145, 0.0]
[[solid]]
grid = { size = [0.1, 0.4, 0.1], resolution = [3, 9, 3] }
translate = [0.0, 0.202, 0.0]
density = 500.0
young = 2.0e6
poisson = 0.3
[[obstacle]]
shape = "plane"
point = [0.0, 0.0, 0.0]
friction = 0.9
thickness = 0.002
)";

/// A block that two plates grip and lift.
const std::string kGripped = R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 10
[[solid]]
grid = { size = [0.1, 0.1, 0.1], resolution = [4, 4, 4] }
translate = [0.0, 0.052, 0.0]
density = 500.0
young = 1.0e5
poisson = 0.3
[[obstacle]]
name = "left"
shape = "box"
center = [-0.11, 0.06, 0.0]
size = [0.1, 0.08, 0.2]
friction = 0.8
thickness = 0.002
motion = { keyframes = [{ time = 0.0 }, { time = 0.3, translate = [0.012, 0.0, 0.0] }, { time = 1.0, translate = [0.012, 0.3, 0.0] }] }
[[obstacle]]
name = "right"
shape = "box"
center = [0.11, 0.06, 0.0]
size = [0.1, 0.08, 0.2]
friction = 0.8
thickness = 0.002
motion = { keyframes = [{ time = 0.0 }, { time = 0.3, translate = [-0.012, 0.0, 0.0] }, { time = 1.0, translate = [-0.012, 0.3, 0.0] }] }
[[obstacle]]
name = "floor"
shape = "plane"
point = [0.0, 0.0, 0.0]
friction = 0.5
thickness = 0.002
)";

Scene scene_of(std::string text, Method method) {
    if (const auto at = text.find("TUBE"); at != std::string::npos) {
        text.replace(at, 4, irregular_tube());
    }
    Scene scene = parse_scene(text, "test.toml");
    scene.solver.method = method;
    return scene;
}

class FreeBody : public testing::TestWithParam<Method> {};

TEST_P(FreeBody, FallsAsFreelyAfterAnyNumberOfIterations) {
    constexpr int kFrames = 20;
    for (const int iterations : {1, 2, 8}) {
        Scene scene = scene_of(kTube, GetParam());
        scene.solver.iterations = iterations;
        ManualRun run(scene);
        const int count = run.model->vertex_count();
        const Momentum start = momentum_of(run, 0, count);
        run.run(kFrames);
        const Momentum end = momentum_of(run, 0, count);
        const Fall fall = free_fall(scene, 0.0, kFrames);
        EXPECT_LT(length(end.place - start.place - fall.x), 5e-5) << iterations << " iterations";
        EXPECT_LT(length(end.velocity - fall.v), 5e-4) << iterations << " iterations";
    }
}

TEST_P(FreeBody, KeepsItsMomentumWhereItIsTorn) {
    for (const int iterations : {1, 3, 10}) {
        Scene scene = scene_of(kTied, GetParam());
        scene.gravity = {};
        scene.solver.iterations = iterations;
        ManualRun run(scene);
        for (float4& x : run.model->positions->span()) {
            x = {1.02f * x.x + 0.01f * x.z, x.y + 0.05f * x.x * x.x, 0.98f * x.z, x.w};
        }
        run.changed(*run.model->positions);
        double fastest = 0.0;
        for (int frame = 0; frame < 6; ++frame) {
            run.run(1);
            for (const float4& u : run.model->velocities->span()) {
                fastest = std::max(fastest, length(to_vec3(u)));
            }
            const int sheet = 9 * 9, stray = 9 * 60, block = 4 * 4 * 4;
            const Vec3 stray_velocity = momentum_of(run, sheet, stray).velocity;
            EXPECT_LT(length(stray_velocity), 1e-4) << "frame " << frame;
            // The block is 4 kg, the sheet 0.05.
            const Momentum cloth = momentum_of(run, 0, sheet);
            const Momentum solid = momentum_of(run, sheet + stray, block);
            EXPECT_LT(length(0.05 * cloth.velocity + 4.0 * solid.velocity), 4.05 * 1e-4);
        }
        EXPECT_GT(fastest, 0.05) << "it moves";
    }
}

/// Of all vertices, about their centre: the angular momentum that they have gained in a substep,
/// m (x - c) x (v - what v was), and all of it without signs [kg m^2/s].
struct Gain {
    Vec3 sum;
    double size = 0.0;
};

Gain gain_of_turning(const ManualRun& run, const std::vector<float4>& before) {
    const int count = run.model->vertex_count();
    const Vec3 centre = momentum_of(run, 0, count).place;
    Gain gain;
    for (int v = 0; v < count; ++v) {
        const auto k = static_cast<std::size_t>(v);
        const Vec3 lever = to_vec3((*run.model->positions)[k]) - centre;
        const Vec3 change = to_vec3((*run.model->velocities)[k]) - to_vec3(before[k]);
        gain.sum = gain.sum + run.model->masses[k] * cross(lever, change);
        gain.size += run.model->masses[k] * length(lever) * length(change);
    }
    return gain;
}

/// Not by xpbd, whose corrections keep angular momentum about where each of them is made.
class SpinningBody : public FreeBody {};

/// As in a step of implicit Euler that is solved, sum m x_(n+1) x (v_(n+1) - v_n) = 0.
TEST_P(SpinningBody, TurnsAsFreelyAfterAnyNumberOfIterations) {
    for (const int iterations : {1, 2, 8}) {
        Scene scene = scene_of(kTube, GetParam());
        scene.gravity = {};
        scene.substeps = 1;
        scene.dt = 0.004;
        scene.solver.iterations = iterations;
        ManualRun run(scene);
        const Vec3 spin{2.0, 1.0, 8.0};  // a quarter of a turn, in the frames below
        const Vec3 centre = momentum_of(run, 0, run.model->vertex_count()).place;
        for (int v = 0; v < run.model->vertex_count(); ++v) {
            const auto k = static_cast<std::size_t>(v);
            const Vec3 way = cross(spin, to_vec3((*run.model->positions)[k]) - centre);
            float4& u = (*run.model->velocities)[k];
            u = {static_cast<float>(way.x), static_cast<float>(way.y), static_cast<float>(way.z),
                 u.w};
        }
        run.changed(*run.model->velocities);
        for (int frame = 0; frame < 50; ++frame) {
            const auto known = run.model->velocities->span();
            const std::vector<float4> before(known.begin(), known.end());
            run.run(1);
            const Gain gain = gain_of_turning(run, before);
            EXPECT_LT(length(gain.sum), 1e-4 * gain.size)
                << iterations << " iterations, frame " << frame;
        }
    }
}

/// The impulse of a plane is all that may change the momentum; afterwards nothing falls through.
TEST_P(FreeBody, LandsOnAnObstacleAndStaysOutOfIt) {
    Scene scene = scene_of(kTube + R"(
[[obstacle]]
shape = "plane"
point = [0.0, 1.9, 0.0]
thickness = 0.002
)",
                           GetParam());
    scene.gravity = {0.0, -9.81, 0.0};
    ManualRun run(scene);
    run.run(40);
    float lowest = 10.0f;
    for (const float4& x : run.model->positions->span()) lowest = std::min(lowest, x.y);
    EXPECT_GT(lowest, 1.902f - 1e-5f);
    EXPECT_LT(lowest, 1.91f) << "it lies on it";
}

/// By vbd with 32 iterations it trembled, and walked by 2 mm/s: the floor pushed single vertices,
/// in each iteration, until what lies over them had followed, and by then by more than it weighs.
TEST_P(FreeBody, LiesStillHoweverOftenItIsPushed) {
    for (const int iterations : {8, 32}) {
        for (const std::string& contact : {std::string(), std::string("\n[contact]\n")}) {
            Scene scene = scene_of(kLying + contact, GetParam());
            scene.solver.iterations = iterations;
            ManualRun run(scene);
            const int count = run.model->vertex_count();
            run.run(30);
            const Vec3 place = momentum_of(run, 0, count).place;
            run.run(30);
            EXPECT_LT(length(momentum_of(run, 0, count).place - place), 2e-5)
                << iterations << " iterations" << contact;
        }
    }
}

/// From the block's first vertex to its last one.
Vec3 diagonal_of(const ManualRun& run) {
    const auto x = positions(run);
    const Vec3 along = at(x, run.model->vertex_count() - 1) - at(x, 0);
    return (1.0 / length(along)) * along;
}

/// What a plane does leaves a body's angular momentum about its normal as it is, and without
/// friction its velocity along the plane. (Such blocks spun by 12 to 108 degrees in 1.5 s.)
TEST_P(FreeBody, SlidesDownAPlaneWithoutTurning) {
    Scene scene = scene_of(kLying, GetParam());
    scene.obstacles.front().friction = 0.0;
    scene.gravity = {3.3552, -9.2184, 0.0};
    for (const int iterations : {2, 8}) {
        scene.solver.iterations = iterations;
        ManualRun run(scene);
        const Vec3 start = diagonal_of(run);
        const Vec3 place = momentum_of(run, 0, run.model->vertex_count()).place;
        run.run(60);
        EXPECT_LT(length(diagonal_of(run) - start), 0.03) << iterations << " iterations";
        const Vec3 way = momentum_of(run, 0, run.model->vertex_count()).place - place;
        EXPECT_NEAR(way.x, 0.5 * 3.3552, 0.01 * 0.5 * 3.3552) << iterations << " iterations";
    }
}

/// It was turned by what its steps left unsolved, until it fell over.
TEST_P(FreeBody, StandsOnASlope) {
    Scene scene = scene_of(kTall, GetParam());
    scene.solver.iterations = 8;
    ManualRun run(scene);
    const Vec3 start = diagonal_of(run);
    run.run(60);
    EXPECT_LT(length(diagonal_of(run) - start), 0.05);
}

/// A block between two plates, in steps that are hardly solved: it is not wound up by them.
TEST_P(FreeBody, IsHeldByWhatGripsIt) {
    Scene scene = scene_of(kGripped, GetParam());
    for (const int iterations : {4, 8}) {
        scene.solver.iterations = iterations;
        ManualRun run(scene);
        const int count = run.model->vertex_count();
        const Vec3 start = diagonal_of(run);
        run.run(240);
        EXPECT_LT(length(diagonal_of(run) - start), 0.05) << iterations << " iterations";
        const Vec3 lifted = diagonal_of(run);
        const Vec3 place = momentum_of(run, 0, count).place;
        run.run(180);
        EXPECT_LT(length(diagonal_of(run) - lifted), 2e-4) << iterations << " iterations";
        EXPECT_LT(length(momentum_of(run, 0, count).place - place), 1e-5) << iterations << " its";
    }
}

TEST_P(FreeBody, IsTheSameForEveryCut) {
    const Scene scene = scene_of(kTied, GetParam());
    const auto opened = [] {
        std::vector<std::unique_ptr<Device>> devices;
        for (int i = 0; i < 2; ++i) devices.push_back(make_cpu_device(1, {}));
        return devices;
    };
    ManualRun run(scene, opened());
    ASSERT_GE(run.strip_count(), 4);
    std::string expected;
    for (int cut = 0; cut <= run.strip_count(); ++cut) {
        run.reset();
        run.run(3, Division{{cut, run.strip_count() - cut}});
        if (cut == 0) expected = run.hash();
        EXPECT_EQ(run.hash(), expected) << "cut at strip " << cut;
    }
}

TEST_P(FreeBody, HasNoTaskWhereThereIsNone) {
    Scene scene = scene_of(kTube, GetParam());
    scene.cloths[0].pins.emplace_back().vertices = {0};
    ManualRun held(scene);
    for (const std::string& kind : held.solver->kinds()) EXPECT_NE(kind, "momentum");
}

INSTANTIATE_TEST_SUITE_P(Solvers, FreeBody, kMethods, name_of_method);
INSTANTIATE_TEST_SUITE_P(Solvers, SpinningBody,
                         testing::Values(Method::kVbd, Method::kSosd, Method::kJpgd,
                                         Method::kNewton),
                         name_of_method);

}  // namespace
}  // namespace weft::test
