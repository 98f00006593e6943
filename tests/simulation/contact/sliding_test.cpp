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

/// What too few iterations leave unsolved.
std::string stiff(double y, int turn) {
    return fmt::format(R"(
[[cloth]]
name = "stiff{1}"
grid = {{ size = [0.3, 0.3], resolution = [20, 20] }}
rotate = [0, 1, 0, {1}]
translate = [-0.1, {0}, 0.003]
density = 0.2
stretch = {{ stiffness = 1.0e4 }}
bend = {{ stiffness = 1.0e-4 }}
)",
                       y, turn);
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
        const int last = static_cast<int>(run.model->bodies.size()) - 1;
        const double before = momentum_of(run, last).velocity.x;
        run.run(12);
        const double across = 1.0 / std::sqrt(1.0 + kTangent * kTangent);
        const double expected = 0.2 * kGravity * across * (kTangent - friction);
        return (momentum_of(run, last).velocity.x - before) / expected;
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
