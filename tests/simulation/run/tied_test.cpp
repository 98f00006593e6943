// Stiff bodies that soft ties hold, by the substeps and iterations that they get by themselves.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

class Tied : public EverySolver {};

/// Hangs in the plane x, y.
std::string sheet(const std::string& name, double y, const std::string& more = "") {
    return "[[cloth]]\nname = \"" + name + R"("
grid = { size = [0.5, 0.3], resolution = [17, 10] }
rotate = [1, 0, 0, 90]
density = 0.3
stretch = { stiffness = 1e5 }
bend = { stiffness = 1e-4 }
damping = 10
translate = [0, )" +
           std::to_string(y) + ", 0]\n" + more;
}

std::string seam(const std::string& above, const std::string& below) {
    return "[[seam]]\na = { cloth = \"" + below + "\", edges = [\"z-\"] }\nb = { cloth = \"" +
           above + R"(", edges = ["z+"] }
stiffness = 60
time = 0.02
)";
}

const std::string kChain = R"(
[scene]
frames = 1
dt = 0.02
substeps = 5
[solver]
iterations = 8
)" + sheet("top", 0.0, "pins = { edges = [\"z-\"] }\n") +
                           sheet("middle", -0.3) + sheet("last", -0.6) + seam("top", "middle") +
                           seam("middle", "last");

constexpr double kWeight = 0.5 * 0.3 * 0.3 * 9.81;
constexpr double kStitches = 17 * 60.0;

/// They fell by half a metre instead, and there was 50 J of strain where 0.02 were to be had.
TEST_P(Tied, SheetsHangAsFarBelowEachOtherAsTheirSeamsGive) {
    ManualRun run(scene_of(kChain));
    const double middle = momentum_of(run, 1).place.y;
    const double last = momentum_of(run, 2).place.y;
    double lowest = 0.0;
    for (int frame = 0; frame < 60; ++frame) {
        run.run(1);
        lowest = std::min(lowest, momentum_of(run, 2).place.y - last);
    }
    EXPECT_GT(lowest, -0.02);
    // xpbd's sheets stretch by more than that.
    if (GetParam() == Method::kXpbd) return;
    const double give = kWeight / kStitches;
    EXPECT_NEAR(momentum_of(run, 1).place.y - middle, -2.0 * give, 0.3 * give);
    EXPECT_NEAR(momentum_of(run, 2).place.y - last, -3.0 * give, 0.3 * give);
}

/// A block that hangs beside its middle turns.
const std::string kBlock = R"(
[scene]
frames = 1
dt = 0.02
substeps = 5
[solver]
iterations = 8
[[cloth]]
name = "up"
grid = { size = [0.6, 0.6], resolution = [7, 7] }
translate = [0, 1, 0]
density = 0.3
stretch = { stiffness = 1e4 }
pins = { box = [[-9, -9, -9], [9, 9, 9]] }
[[solid]]
name = "block"
grid = { size = [0.6, 0.1, 0.6], resolution = [7, 2, 7] }
translate = [0, 0.84, 0]
density = 500
young = 1e8
poisson = 0.3
damping = 10
[[attachment]]
a = "block"
b = "up"
box = [[-1, 0.88, -1], [0.15, 0.9, 1]]
stiffness = 300
)";

/// Five of seven rows of ties, from x = -0.3 to 0.1, give way by a + b x. Of these, forces and
/// torques say a (1 - 0.1 / 0.3) = -weight / stiffness, and b = a / 0.3.
TEST_P(Tied, BlocksTurnToWhereTheyHang) {
    ManualRun run(scene_of(kBlock));
    const double start = momentum_of(run, 1).place.y;
    run.run(100);
    const double weight = 0.6 * 0.1 * 0.6 * 500 * 9.81;
    const double give = 1.5 * weight / (5 * 7 * 300.0);
    EXPECT_NEAR(momentum_of(run, 1).place.y - start, -give, 0.1 * give);
    const auto x = positions(run);
    double left = 1.0;
    double right = 1.0;
    for (int v = 49; v < static_cast<int>(x.size() / 3); ++v) {
        const Vec3 place = at(x, v);
        if (place.x < -0.28) left = std::min(left, place.y);
        if (place.x > 0.28) right = std::min(right, place.y);
    }
    EXPECT_NEAR(right - left, -0.6 * give / 0.3, 0.12 * give / 0.3);
    RecordProperty("sag", std::to_string(momentum_of(run, 1).place.y - start));
    RecordProperty("turn", std::to_string(right - left));
}

INSTANTIATE_TEST_SUITE_P(Methods, Tied, kMethods, name_of_method);

}  // namespace
}  // namespace weft::test
