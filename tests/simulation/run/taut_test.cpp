// Cloth that pins hold on two sides, with the substeps that are chosen for it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

class Taut : public EverySolver {};

/// Threads that run from one end to the other, and none across: so many strings, 1 m long.
const std::string kStrings = R"(
[scene]
frames = 1
dt = 0.016666667
[[cloth]]
grid = { size = [1.0, 0.125], resolution = [33, 5] }
density = 0.2
woven = { warp = 2000.0, weft = 1.0, shear = 1.0 }
damping = 8.0
pins = { edges = ["x-", "x+"] }
)";
constexpr double kLoad = 9.81 * 0.2;  // [N/m^2]

double sag_of(const Scene& scene) {
    ManualRun run(scene);
    run.run(120);
    const auto end = positions(run);
    double sag = 0.0;
    for (int v = 0; v < run.model->vertex_count(); ++v) sag = std::max(sag, -at(end, v).y);
    return sag;
}

/// A parabola of sag s is 8/3 s^2 / L longer than its span L, and its tension per width is q L^2 /
/// (8 s). By xpbd with the substeps that keep strain at half a per cent, it was 1.8 times as much.
TEST_P(Taut, StringsSagAsTheClosedFormSays) {
    const double sag = std::cbrt(3.0 * kLoad / (64.0 * 2000.0));
    EXPECT_NEAR(sag_of(scene_of(kStrings)), sag, 0.06 * sag);
}

INSTANTIATE_TEST_SUITE_P(Methods, Taut, kMethods, name_of_method);

}  // namespace
}  // namespace weft::test
