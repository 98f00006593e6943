// Stiff bodies in contact, after far too few iterations for them: as wholes they move as mechanics
// says, by all methods that know contacts.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "simulation/scene/read_scene.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

constexpr double kGravity = 9.81;
constexpr double kTangent = 0.3;

std::string head(int iterations, const std::string& contact) {
    return fmt::format(R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 10
[solver]
iterations = {}
{}
)",
                       iterations, contact);
}

const std::string kContact = "[contact]\nthickness = 0.004\n";

/// Two triangles: a finer one is a washboard.
const std::string kSlope = R"(
[[cloth]]
name = "slope"
grid = { size = [1.2, 0.8], resolution = [2, 2] }
density = 0.2
stretch = { stiffness = 20.0 }
pins = { box = [[-9, -9, -9], [9, 9, 9]] }
)";

const std::string kPlane = R"(
[[obstacle]]
shape = "plane"
point = [0.0, 0.0, 0.0]
thickness = 0.0034
)";

std::string sheet(double y, int turn, double stiffness, int resolution) {
    return fmt::format(R"(
[[cloth]]
name = "sheet{1}"
grid = {{ size = [0.3, 0.3], resolution = [{3}, {3}] }}
rotate = [0, 1, 0, {1}]
translate = [-0.1, {0}, 0.003]
density = 0.2
stretch = {{ stiffness = {2} }}
bend = {{ stiffness = 1.0e-4 }}
)",
                       y, turn, stiffness, resolution);
}

/// What too few iterations leave unsolved.
std::string stiff(double y, int turn) { return sheet(y, turn, 1.0e4, 20); }

const std::string kGround = R"(
[[obstacle]]
shape = "mesh"
grid = { size = [3.0, 1.0], resolution = [13, 5] }
)";

std::string block(double y, double young, int number) {
    return fmt::format(R"(
[[solid]]
name = "block{2}"
grid = {{ size = [0.2, 0.1, 0.15], resolution = [6, 4, 5] }}
rotate = [0, 1, 0, 17]
translate = [-0.1, {0}, 0.003]
density = 300.0
young = {1}
poisson = 0.3
)",
                       y, young, number);
}

class Unconverged : public EverySolver {
protected:
    /// Gravity leans.
    static Scene on_slope(const std::string& text) {
        Scene scene = scene_of(text);
        const double across = 1.0 / std::sqrt(1.0 + kTangent * kTangent);
        scene.gravity = {kGravity * kTangent * across, -kGravity * across, 0.0};
        return scene;
    }
    /// How fast the last body is after 12 frames, in parts of what Coulomb says.
    static double speed(const Scene& scene, double friction) {
        ManualRun run(scene);
        return gain(run, friction);
    }
    /// Likewise what 12 frames add to its speed.
    static double gain(ManualRun& run, double friction) {
        return gain(run, friction, run.model->bodies.back());
    }
    static double gain(ManualRun& run, double friction, const BodyRange& of) {
        const auto speed = [&] {
            return momentum_of(run, of.first_vertex, of.vertex_count).velocity.x;
        };
        const double before = speed();
        run.run(12);
        const double across = 1.0 / std::sqrt(1.0 + kTangent * kTangent);
        return (speed() - before) / (0.2 * kGravity * across * (kTangent - friction));
    }
};

TEST_P(Unconverged, SlidesDownClothAsPhysicsSays) {
    for (const int iterations : {2, 8}) {
        const Scene scene = on_slope(head(iterations, kContact) + kSlope + stiff(0.0034, 13));
        EXPECT_NEAR(speed(scene, 0.0), 1.0, 0.005) << iterations << " iterations";
    }
}

/// Friction goes by how hard contacts press, of which few iterations leave much that is not there.
/// (At first the sheet is thrown up a little, and nothing rubs it.)
TEST_P(Unconverged, RubsOnClothAsCoulombSays) {
    const std::string friction = kContact + "friction = 0.1\n";
    for (const int iterations : {2, 6, 8, 40}) {
        const Scene scene = on_slope(head(iterations, friction) + kSlope + stiff(0.0034, 13));
        ManualRun run(scene);
        gain(run, 0.1);
        for (int part = 1; part <= 2; ++part) {
            const double tolerance = iterations == 2 ? 0.1 : 0.015;
            EXPECT_NEAR(gain(run, 0.1), 1.0, tolerance)
                << iterations << " iterations, part " << part;
        }
    }
}

/// On the other side of tan = mu: what sticks stays, but for the way in which it comes to rest.
TEST_P(Unconverged, SticksToClothAsCoulombSays) {
    const std::string friction = kContact + "friction = 0.4\n";
    const double most = GetParam() == Method::kJpgd ? 2e-4 : 2e-6;
    for (const int iterations : {8, 40}) {
        ManualRun run(on_slope(head(iterations, friction) + kSlope + stiff(0.0034, 13)));
        run.run(12);
        const double before = momentum_of(run, 1).place.x;
        run.run(12);
        EXPECT_LT(std::abs(momentum_of(run, 1).place.x - before), most)
            << iterations << " iterations";
    }
}

/// Not even their weight arrives at the contacts of stiff solids, or hundreds of times as much.
TEST_P(Unconverged, SolidsRubAsCoulombSays) {
    const std::string friction = kContact + "friction = 0.2\n";
    for (const double young : {2.0e5, 2.0e7}) {
        for (const int iterations : {2, 8}) {
            ManualRun run(on_slope(head(iterations, friction) + block(0.0536, young, 0) + kGround));
            run.run(12);
            for (int part = 1; part <= 2; ++part) {
                EXPECT_NEAR(gain(run, 0.2, run.model->bodies[0]), 1.0, 0.05)
                    << young << " Pa, " << iterations << " iterations, part " << part;
            }
        }
    }
}

/// What lies between two others is pressed by both.
TEST_P(Unconverged, PilesRubAsCoulombSays) {
    const std::string friction = kContact + "friction = 0.2\n";
    const std::string low = sheet(0.0036, 13, 1.0e3, 12);
    for (const std::string& pile :
         {low + block(0.0572, 2.0e5, 0), low + sheet(0.0072, 20, 1.0e3, 12),
          block(0.0536, 2.0e5, 0) + block(0.1572, 2.0e5, 1)}) {
        for (const int iterations : {2, 8}) {
            if (GetParam() == Method::kNewton && iterations == 8) continue;  // 10 s
            ManualRun run(on_slope(head(iterations, friction) + pile + kGround));
            run.run(12);
            const BodyRange& high = run.model->bodies[1];
            BodyRange all = run.model->bodies[0];
            all.vertex_count += high.vertex_count;
            EXPECT_NEAR(gain(run, 0.2, all), 1.0, 0.15) << iterations << " iterations" << pile;
            EXPECT_NEAR(gain(run, 0.2, high), 1.0, 0.15) << iterations << " iterations" << pile;
        }
    }
}

TEST_P(Unconverged, SlidesDownAnObstacleAsPhysicsSays) {
    for (const std::string& contact : {std::string(), kContact}) {
        const std::string text = head(8, contact) + stiff(0.0034, 13) + kPlane;
        EXPECT_NEAR(speed(on_slope(text), 0.0), 1.0, 0.005);
        EXPECT_NEAR(speed(on_slope(text + "friction = 0.1\n"), 0.1), 1.0, 0.005);
    }
}

/// Which are pressed together, and part; their common fall is nobody's business but gravity's.
TEST_P(Unconverged, PairsFallFreely) {
    for (const int iterations : {2, 8}) {
        ManualRun run(scene_of(head(iterations, kContact) + stiff(0.0034, 5) + stiff(0.0068, 20)));
        run.run(12);
        const Fall fall = free_fall(run.model->scene, 0.0, 12);
        const double low = momentum_of(run, 0).velocity.y;
        const double high = momentum_of(run, 1).velocity.y;
        EXPECT_NEAR(0.5 * (low + high) / fall.v.y, 1.0, 1e-3) << iterations << " iterations";
        EXPECT_GT(high - low, 0.01) << "they part";
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, Unconverged, kMethods, name_of_method);

}  // namespace
}  // namespace weft::test
