// Piles of light, stiff sheets that fall on a floor together, by settings that nobody tuned.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "simulation/scene/read_scene.h"
#include "simulation/state/diagnostics.h"
#include "tests/simulation/run/one_plan.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

/// Nine sheets, each turned by another 9 degrees, some of them ten times as stiff as others.
std::string pile() {
    std::string text = R"(
[scene]
frames = 60
dt = 0.016666667
[contact]
friction = 0.5
[[obstacle]]
shape = "plane"
point = [0.0, 0.0, 0.0]
friction = 0.5
)";
    for (int i = 0; i < 9; ++i) {
        text +=
            fmt::format(R"(
[[cloth]]
grid = {{ size = [0.5, 0.5], resolution = [10, 10] }}
translate = [0.0, {}, 0.0]
rotate = [0.0, 1.0, 0.0, {}]
density = {}
stretch = {{ stiffness = {} }}
)",
                        0.1 + 0.012 * i, 9 * i, i % 3 == 0 ? 0.5 : 0.1, i % 2 == 0 ? 1.0e5 : 1.0e4);
    }
    return text;
}

class PileOf : public testing::TestWithParam<Method> {};

/// Contacts a hundred times as stiff as few iterations can solve stored five times the energy of
/// the fall where it lands; and what they made lifted the pile again.
TEST_P(PileOf, SheetsLandAndLie) {
    Scene scene = parse_scene(pile(), "test.toml");
    scene.solver.method = GetParam();
    Simulation simulation = simulation_of(scene);
    const double start = simulation.energies().gravity;
    double stored = 0.0;
    double lowest = start;
    double gained = 0.0;
    while (simulation.frame() < scene.frames) {
        gained = std::max(gained, simulation.advance().gained);
        stored = std::max(stored, simulation.energies().strain());
        lowest = std::min(lowest, simulation.energies().gravity);
    }
    const double fall = start - lowest;
    EXPECT_LT(stored, 2.0 * fall);
    EXPECT_LT(gained, 0.5 * fall);
    EXPECT_LT(simulation.energies().gravity - lowest, 0.05 * fall);
    EXPECT_LT(simulation.energies().kinetic, 0.01 * fall);
    EXPECT_TRUE(simulation.troubles().empty());
}

INSTANTIATE_TEST_SUITE_P(Methods, PileOf,
                         testing::Values(Method::kXpbd, Method::kVbd, Method::kSosd, Method::kJpgd),
                         name_of_method);

}  // namespace
}  // namespace weft::test
