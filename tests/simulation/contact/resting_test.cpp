// Bodies that rest on each other: forces and drift against what mechanics says.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "simulation/contact/response.h"
#include "simulation/families/convert.h"
#include "simulation/scene/read_scene.h"
#include "tests/simulation/contact/blocks.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

constexpr double kGravity = 9.81;
constexpr double kSway = 3e-4;  ///< of what rests, at the most [m]

const std::string kFloor = R"(
[[cloth]]
name = "floor"
grid = { size = [1.2, 0.8], resolution = [2, 2] }
density = 0.2
stretch = { stiffness = 20.0 }
pins = { box = [[-9, -9, -9], [9, 9, 9]] }
)";

std::string patch(double stiffness) {
    return fmt::format(R"(
[[cloth]]
name = "patch"
grid = {{ size = [0.1, 0.1], resolution = [7, 7] }}
rotate = [0, 1, 0, 13]
translate = [-0.1, 0.0034, 0.003]
density = 0.2
stretch = {{ stiffness = {} }}
)",
                       stiffness);
}

/// How contacts with others push a body, at the last substep's end [N].
Vec3 push_on(ManualRun& run, int body) {
    const auto x = run.model->positions->span();
    Vec3 sum;
    for (const FrozenContact& contact : run.solver->contact()->frozen()) {
        const double force = contact.force(contact.way(x));
        for (std::size_t k = 0; k < 4; ++k) {
            if (body_of(run, contact.corners[k]) != body) continue;
            sum = sum + force * contact.weights[k] * contact.normal;
        }
    }
    return sum;
}

class Resting : public EverySolver {};

std::string column_of(int blocks, int iterations) {
    std::string text = head(iterations, "friction = 0.3\n") + kFloor;
    for (int i = 0; i < blocks; ++i) {
        const Vec3 place{0.001 * i, 0.0535 + 0.1035 * i, 0.002 * i};
        text += block(fmt::format("block{}", i), place, 200.0, 2e5, 7 * i);
    }
    return text;
}

/// A column of blocks that has stood for a second, and stands for half a second more.
struct Column {
    explicit Column(Method method, int iterations) {
        const std::string text = column_of(kBlocks, iterations);
        Scene scene = parse_scene(text, "test.toml");
        scene.solver.method = method;
        ManualRun run(scene);
        run.run(60);
        for (int b = 0; b < kBlocks; ++b) moved[at(b)] = momentum_of(run, b + 1).place;
        constexpr int kFrames = 30;
        for (int frame = 0; frame < kFrames; ++frame) {
            run.run(1);
            for (int b = 0; b < kBlocks; ++b) pushed[at(b)] += push_on(run, b + 1).y / kFrames;
        }
        for (int b = 0; b < kBlocks; ++b) {
            const Momentum now = momentum_of(run, b + 1);
            pushed[at(b)] /= now.mass * kGravity;
            moved[at(b)] = now.place - moved[at(b)];
        }
    }
    static constexpr int kBlocks = 3;
    static std::size_t at(int b) { return static_cast<std::size_t>(b); }
    std::array<double, kBlocks> pushed{};  ///< on average of its swings, in parts of its weight
    std::array<Vec3, kBlocks> moved;       ///< [m]
};

/// Each block is pushed by its weight: what lies below it carries all that is above.
TEST_P(Resting, ColumnOfBlocksWeighsWhatItDoes) {
    for (const double pushed : Column(GetParam(), 8).pushed) EXPECT_NEAR(pushed, 1.0, 0.1);
}

TEST_P(Resting, ColumnOfBlocksStaysWhereItIs) {
    for (const Vec3 moved : Column(GetParam(), 8).moved) EXPECT_LT(length(moved), kSway);
}

/// A slender one: without turns and strains of bodies as wholes its top walked by 8 to 10 mm in
/// this second, and with turns alone by 2 to 3.
TEST_P(Resting, SlenderColumnHardlyWalksByFewIterations) {
    ManualRun run(scene_of(column_of(4, 8)));
    run.run(90);
    const Vec3 before = momentum_of(run, 4).place;
    run.run(60);
    EXPECT_LT(length(momentum_of(run, 4).place - before), 0.001);
}

const std::string kRubbing = R"(
[contact]
thickness = 0.01
friction = 0.5
)";

/// So many blocks above each other, 1 cm above what is at 0.
std::string blocks(int count, double young, const std::string& contact = kRubbing) {
    return fmt::format(R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 6
[solver]
iterations = 8
{}
[[solid]]
grid = {{ size = [0.2, 0.1, 0.2], resolution = [5, 3, 5] }}
copies = {{ count = {}, translate = [0, 0.11, 0] }}
translate = [0, 0.06, 0]
density = 300.0
young = {}
poisson = 0.3
)",
                       contact, count, young);
}

const std::string kTwoBlocks = blocks(2, 1e6) + R"(
[[obstacle]]
shape = "mesh"
grid = { size = [4.0, 4.0], resolution = [17, 17] }
)";

/// The most in the ten frames behind that many [J].
double motion_behind(const Scene& scene, int frames) {
    ManualRun run(scene);
    run.run(frames);
    double kinetic = 0.0;
    for (int frame = 0; frame < 10; ++frame) {
        run.run(1);
        kinetic = std::max(kinetic, kinetic_energy(run));
    }
    return kinetic;
}

/// Unless bodies are led as wholes before the first iteration, too, these rattle for ever by vbd,
/// sosd and jpgd.
TEST_P(Resting, BlocksOnEachOtherComeToRest) {
    EXPECT_LT(motion_behind(scene_of(kTwoBlocks), 120), 1e-5);
}

/// Each turned by 7 degrees more, all else left out but friction.
const std::string kTurnedTower = R"(
[scene]
frames = 1
dt = 0.016666667
[contact]
friction = 0.4
[[solid]]
grid = { size = [0.2, 0.1, 0.2], resolution = [5, 3, 5] }
translate = [0.01, 0.062, 0.02]
rotate = [0.0, 1.0, 0.0, 7.0]
density = 500.0
young = 1.0e6
poisson = 0.3
copies = { count = 3, translate = [0.0, 0.105, 0.0], rotate = [0.0, 1.0, 0.0, 7.0] }
[[obstacle]]
shape = "plane"
point = [0.0, 0.0, 0.0]
friction = 0.4
)";

/// Contacts as stiff as elements are trembled for ever, with up to 1e-3 J.
TEST_P(Resting, BlocksTurnedOnEachOtherLieStill) {
    EXPECT_LT(motion_behind(scene_of(kTurnedTower), 50), 1e-5);
}

class RestingOnPlanes : public Resting {};

/// The lowest one falls by 5 mm.
std::string blocks_on_plane(int count, double young, double friction,
                            const std::string& contact = kRubbing) {
    return blocks(count, young, contact) + fmt::format(R"(
[[obstacle]]
shape = "plane"
point = [0, 0, 0]
normal = [0, 1, 0]
thickness = 0.005
friction = {}
)",
                                                       friction);
}

/// Pushed out of the plane vertex by vertex alone, it had a thousand times the energy of its fall.
TEST_P(RestingOnPlanes, StiffBlockThatFallsOnAPlaneLies) {
    for (const auto& [friction, contact] :
         {std::pair{0.0, kRubbing}, {0.5, kRubbing}, {0.0, std::string()}, {0.5, std::string()}}) {
        ManualRun run(scene_of(blocks_on_plane(1, 1e8, friction, contact)));
        double most = 0.0;
        for (int frame = 0; frame < 30; ++frame) {
            run.run(1);
            most = std::max(most, kinetic_energy(run));
        }
        EXPECT_LT(most, momentum_of(run, 0).mass * kGravity * 0.005) << "more than its fall gives";
        EXPECT_LT(kinetic_energy(run), 1e-6);
        const Vec3 place = momentum_of(run, 0).place;
        EXPECT_NEAR(place.y, 0.055, 1e-5);
        EXPECT_LT(std::hypot(place.x, place.z), 2e-4);
    }
}

/// Where presses tell how friction is shared out while strains have just changed them, it turns.
TEST_P(RestingOnPlanes, BlockThatSlidesDownDoesNotTurn) {
    ManualRun run(scene_of(R"(
[scene]
frames = 1
dt = 0.02
substeps = 8
gravity = [3.355, -9.218, 0]
[solver]
iterations = 8
[[solid]]
grid = { size = [0.2, 0.1, 0.2], resolution = [6, 4, 5] }
rotate = [0, 1, 0, 17]
translate = [0, 0.0501, 0]
density = 300
young = 2e5
poisson = 0.3
[[obstacle]]
shape = "plane"
point = [0, 0, 0]
normal = [0, 1, 0]
friction = 0.1
)"));
    const auto place_of = [&](int vertex) {
        const auto own = static_cast<std::size_t>(run.model->vertex(SceneVertex{vertex}));
        return to_vec3((*run.model->positions)[own]);
    };
    const auto direction = [&] {
        const Vec3 way = place_of(run.model->vertex_count() - 1) - place_of(0);
        return std::atan2(way.z, way.x);
    };
    const double start = direction();
    const Vec3 place = momentum_of(run, 0).place;
    run.run(50);
    EXPECT_NEAR(direction(), start, 0.02) << "1.1 degrees";
    EXPECT_NEAR(momentum_of(run, 0).place.x - place.x, 0.5 * (3.355 - 0.9218), 0.01);
}

TEST_P(RestingOnPlanes, StiffBlocksOnAPlaneComeToRest) {
    ManualRun run(scene_of(blocks_on_plane(2, 1e7, 0.5)));
    run.run(90);
    const Vec3 before = momentum_of(run, 1).place;
    run.run(60);
    EXPECT_LT(kinetic_energy(run), 1e-5);
    EXPECT_LT(length(momentum_of(run, 1).place - before), 1e-4);
}

/// 1 : 1000.
TEST_P(Resting, LightBlockBearsAHeavyOne) {
    ManualRun run(scene_of(head(8, "friction = 0.5\n") + kFloor +
                           block("light", {0, 0.0535, 0}, 2.0, 1e6, 0) +
                           block("heavy", {0, 0.157, 0}, 2000.0, 1e6, 0)));
    run.run(30);
    const Vec3 before = momentum_of(run, 2).place;
    run.run(20);
    EXPECT_LT(length(momentum_of(run, 2).place - before), kSway);
    EXPECT_GT(momentum_of(run, 2).place.y - momentum_of(run, 1).place.y, 0.1)
        << "it is not crushed";
}

/// The other way round, 1 : 10,000, on one that swings, without friction. What single contacts of
/// it press too hard is many times the light one's weight; in one round of the bodies' steps that
/// threw it aside by tens of centimetres.
TEST_P(Resting, LightBlockIsNotThrownByAHeavyOne) {
    Scene scene = parse_scene(R"(
[scene]
frames = 30
dt = 0.016666667
substeps = 4
[solver]
iterations = 8
[contact]
thickness = 0.01
[[solid]]
name = "lower"
grid = { size = [0.4, 0.2, 0.4], resolution = [5, 3, 5] }
density = 1.0e5
young = 1.0e7
poisson = 0.3
pins = { faces = ["y-"] }
[[solid]]
name = "upper"
grid = { size = [0.2, 0.2, 0.2], resolution = [3, 3, 3] }
translate = [0.01, 0.21, 0.02]
rotate = [0.0, 1.0, 0.0, 5.0]
density = 10.0
young = 1.0e7
poisson = 0.3
)",
                              "test.toml");
    scene.solver.method = GetParam();
    ManualRun run(scene);
    const Vec3 before = momentum_of(run, 1).place;
    run.run(30);
    const Vec3 gone = momentum_of(run, 1).place - before;
    EXPECT_LT(std::hypot(gone.x, gone.z), 0.01);
    EXPECT_LT(std::abs(gone.y), 0.01);
}

/// With WEFT_LONG=1, for 60 s.
TEST_P(Resting, PatchStaysWhereItIs) {
    const bool is_long = std::getenv("WEFT_LONG") != nullptr;
    for (const double stiffness : {20.0, 1e4}) {
        ManualRun run(scene_of(head(8, "friction = 0.3\n") + kFloor + patch(stiffness)));
        run.run(30);
        const std::vector<float> before = positions(run);
        run.run(is_long ? 3600 : 180);
        EXPECT_LT(difference(before, positions(run)), is_long ? 1e-4 : 5e-6);
    }
}

const std::string kTurnedSheets = R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 8
[solver]
iterations = 8
[contact]
thickness = 0.005
friction = 0.3
[[cloth]]
grid = { size = [0.3, 0.3], resolution = [13, 13] }
copies = { count = 5, translate = [0, 0.006, 0], rotate = [0, 1, 0, 15] }
translate = [0, 0.006, 0]
density = 0.3
stretch = { stiffness = 1e3 }
bend = { stiffness = 1e-5 }
[[obstacle]]
shape = "mesh"
grid = { size = [2.0, 2.0], resolution = [9, 9] }
)";

/// Corners that hang down push what is below them aside, and friction bears that. By xpbd the
/// lowest sheet had none, and was at 10 mm.
TEST_P(Resting, SheetsThatLieTurnedOnEachOtherStay) {
    ManualRun run(scene_of(kTurnedSheets));
    const BodyRange& lowest = run.model->bodies[0];
    const std::vector<float> before = positions(run);
    run.run(30);
    const std::vector<float> after = positions(run);
    double most = 0.0;
    for (int v = lowest.first_vertex; v < lowest.first_vertex + lowest.vertex_count; ++v) {
        const Vec3 gone = at(after, v) - at(before, v);
        most = std::max(most, std::hypot(gone.x, gone.z));
    }
    EXPECT_LT(most, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Methods, RestingOnPlanes,
                         testing::Values(Method::kVbd, Method::kSosd, Method::kJpgd),
                         name_of_method);
INSTANTIATE_TEST_SUITE_P(Methods, Resting,
                         testing::Values(Method::kVbd, Method::kSosd, Method::kJpgd, Method::kXpbd),
                         name_of_method);

}  // namespace
}  // namespace weft::test
