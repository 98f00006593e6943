// Cloth on obstacles: what should slide does, what should stay does, and what bears a load gains no
// energy by that.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulation/scene/read_scene.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

/// 13 x 31 vertices over a rail along x, its middle 15 cm aside.
const std::string kOverRail = R"(
[scene]
frames = 1
dt = 0.016666667
[[cloth]]
grid = { size = [0.4, 1.0], resolution = [13, 31] }
translate = [0.0, 0.06, 0.15]
density = 0.2
stretch = { stiffness = 1.0e3 }
damping = 0.5
[[obstacle]]
shape = "capsule"
start = [-0.5, 0.0, 0.0]
end = [0.5, 0.0, 0.0]
radius = 0.05
friction = 0.15
)";

/// A sheet, half of which hangs over the edge of a table.
const std::string kOverEdge = R"(
[scene]
frames = 1
dt = 0.016666667
[[cloth]]
grid = { size = [0.4, 0.8], resolution = [13, 25] }
translate = [0.0, 0.0035, 0.0]
density = 0.2
stretch = { stiffness = 1.0e3 }
damping = 0.5
[[obstacle]]
shape = "box"
center = [0.0, -0.25, -0.5]
size = [1.0, 0.5, 1.0]
friction = 0.6
thickness = 0.002
)";

class DrapedCloth : public EverySolver {
protected:
    ManualRun run_of(const std::string& text, int iterations, const std::string& contact = "") {
        Scene scene = scene_of(text + contact);
        scene.solver.iterations = iterations;
        return ManualRun(scene);
    }
    static double highest(const ManualRun& run) {
        double most = -1e9;
        const auto x = positions(run);
        for (std::size_t y = 1; y < x.size(); y += 3) most = std::max(most, double{x[y]});
        return most;
    }
};

/// By what one side weighs more than the other, e^(mu pi) times. By vbd, sosd and jpgd it stuck.
TEST_P(DrapedCloth, SlidesOffARail) {
    for (const char* contact : {"", "[contact]\n"}) {
        ManualRun run = run_of(kOverRail, 8, contact);
        run.run(90);
        EXPECT_LT(highest(run), 0.0) << contact;
    }
}

TEST_P(DrapedCloth, StaysOnARailThatIsRoughEnough) {
    Scene scene = scene_of(kOverRail);
    scene.solver.iterations = 8;
    scene.cloths[0].transform.translate.z = 0.03;
    scene.obstacles[0].friction = 0.5;
    ManualRun run(scene);
    run.run(60);
    const auto before = positions(run);
    run.run(30);
    const auto after = positions(run);
    int on_top = 0;
    for (int v = 0; v < run.model->vertex_count(); ++v) {
        if (at(before, v).y < 0.045) continue;
        ++on_top;
        EXPECT_LT(length(at(after, v) - at(before, v)), 0.01) << v;
    }
    EXPECT_GT(on_top, 10);
}

TEST_P(DrapedCloth, HangsOverAnEdge) {
    for (const int iterations : {4, 8}) {
        ManualRun run = run_of(kOverEdge, iterations);
        run.run(60);
        const Vec3 rear = at(positions(run), 6);
        EXPECT_LT(rear.z, -0.37) << iterations;
        run.run(30);
        EXPECT_NEAR(at(positions(run), 6).z, rear.z, 1e-3) << iterations;
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, DrapedCloth, kMethods, name_of_method);

class LoadedCloth : public EverySolver {};

/// An obstacle that bears no more of the sheet than what it weighs lets the load sink in: contacts
/// stored a hundred times what the fall gives.
TEST_P(LoadedCloth, BearsABlockThatFallsOnIt) {
    ManualRun run(scene_of(R"(
[scene]
frames = 1
dt = 0.016666667
[solver]
iterations = 8
[contact]
friction = 0.3
[[cloth]]
grid = { size = [0.4, 0.4], resolution = [21, 21] }
translate = [0, 0.004, 0]
density = 0.2
stretch = { stiffness = 1e3 }
[[solid]]
grid = { size = [0.1, 0.1, 0.1], resolution = [4, 4, 4] }
translate = [0, 0.07, 0]
density = 5000
young = 1e6
poisson = 0.3
[[obstacle]]
shape = "plane"
point = [0, 0, 0]
friction = 0.3
thickness = 0.002
)"));
    const double start = momentum_of(run, 1).place.y;
    for (int frame = 0; frame < 30; ++frame) {
        run.run(1);
        const Momentum block = momentum_of(run, 1);
        const double had = block.mass * 9.81 * (start - block.place.y);
        ASSERT_LT(kinetic_energy(run), had + 1e-3) << frame;
        ASSERT_GT(block.place.y, 0.05) << frame;
    }
    EXPECT_LT(kinetic_energy(run), 1e-4);
    EXPECT_NEAR(momentum_of(run, 1).place.y, 0.058, 5e-4);
}

/// (Newton and xpbd know nothing of it.)
INSTANTIATE_TEST_SUITE_P(Methods, LoadedCloth,
                         testing::Values(Method::kVbd, Method::kSosd, Method::kJpgd),
                         name_of_method);

}  // namespace
}  // namespace weft::test
