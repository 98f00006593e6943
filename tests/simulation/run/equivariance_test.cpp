// Nothing depends on where the origin is, nor on the units of time and length: scenes of cloth, a
// solid, ties and an obstacle with friction. Cloth and solids alone, turned and with other units of
// mass: physics_test.cpp, solids_test.cpp; cloth alone in other units of length: stiff_test.cpp.

#include <gtest/gtest.h>

#include <cmath>

#include "simulation/checks/start_checks.h"
#include "simulation/scene/read_scene.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

class Equivariant : public EverySolver {};

constexpr int kFrames = 15;

/// The brick falls upon the slope and slides, and draws the sheet that is tied to its top after it.
const std::string kTiedBrick = R"(
[scene]
frames = 1
dt = 0.015625
substeps = 8
[solver]
iterations = 4
[[cloth]]
name = "sheet"
grid = { size = [0.5, 0.5], resolution = [9, 9] }
translate = [0.0, 0.23, 0.0]
density = 0.25
stretch = { stiffness = 1.0e3 }
bend = { stiffness = 1.0e-3 }
damping = 0.5
[[solid]]
name = "brick"
grid = { size = [0.25, 0.125, 0.125], resolution = [5, 3, 3] }
translate = [0.0, 0.125, 0.0]
density = 100.0
young = 1.0e4
poisson = 0.3
[[attachment]]
a = "brick"
b = "sheet"
faces = ["y+"]
stiffness = 100.0
[[obstacle]]
shape = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 1.0, 0.25]
friction = 0.25
)";

std::vector<float> scaled(std::vector<float> values, double factor) {
    for (float& value : values) value = static_cast<float>(factor * static_cast<double>(value));
    return values;
}

/// It is not by standing still that results agree.
void expect_slid(const ManualRun& run, const std::vector<float>& start) {
    EXPECT_GT(difference(start, positions(run)), 0.05);
}

TEST_P(Equivariant, MovedSceneGivesTheMovedResult) {
    const auto run_moved = [](Vec3 by) {
        Scene scene = scene_of(kTiedBrick);
        for (Vec3* place :
             {&scene.cloths[0].transform.translate, &scene.solids[0].transform.translate,
              &scene.obstacles[0].frame.origin}) {
            *place = *place + by;
        }
        ManualRun run(scene);
        const auto start = positions(run);
        run.run(kFrames);
        expect_slid(run, start);
        auto now = positions(run);
        for (std::size_t v = 0; v < now.size(); v += 3) {
            now[v] -= static_cast<float>(by.x);
            now[v + 1] -= static_cast<float>(by.y);
            now[v + 2] -= static_cast<float>(by.z);
        }
        return now;
    };
    const auto here = run_moved({});
    EXPECT_LT(difference(here, run_moved({0.3, -0.7, 0.9})), 2e-3);
    EXPECT_LT(difference(here, run_moved({-1.1, 2.3, 0.1})), 2e-3);
}

TEST_P(Equivariant, TimesScaledByPowersOfTwoChangeNoBit) {
    const auto run_scaled = [](double factor) {
        Scene scene = scene_of(kTiedBrick);
        const double squared = factor * factor;
        scene.dt *= factor;
        scene.gravity = (1.0 / squared) * scene.gravity;
        scene.cloths[0].stretch.stiffness /= squared;
        scene.cloths[0].bend->stiffness /= squared;
        *scene.cloths[0].damping /= factor;
        scene.solids[0].material.young /= squared;
        scene.attachments[0].stiffness /= squared;
        ManualRun run(scene);
        const auto start = positions(run);
        run.run(kFrames);
        expect_slid(run, start);
        return std::pair{positions(run), scaled(velocities(run), factor)};
    };
    const auto seconds = run_scaled(1.0);
    EXPECT_EQ(seconds, run_scaled(std::pow(2.0, -10)));
    EXPECT_EQ(seconds, run_scaled(std::pow(2.0, 6)));
}

/// Where single precision no longer holds the motion, the start says so, and only there: bodies may
/// be far from the origin, but not from each other.
TEST_P(Equivariant, PlacesTooFarForSinglePrecisionAreTold) {
    const auto warnings_at = [](double sheet, double brick) {
        Scene scene = scene_of(kTiedBrick);
        scene.obstacles.clear();
        scene.cloths[0].transform.translate.x += sheet;
        scene.solids[0].transform.translate.x += brick;
        Warnings warnings;
        warn_of_start(Model(scene, warnings), warnings);
        return warnings;
    };
    EXPECT_TRUE(warnings_at(1e6, 1e6).empty());
    EXPECT_TRUE(warnings_at(0.0, 100.0).empty());
    for (const auto& [both, apart] : {std::pair{0.0, 1000.0}, {0.0, 8000.0}, {1e6, 8000.0}}) {
        const Warnings far = warnings_at(both, both + apart);
        ASSERT_EQ(far.size(), 1U);
        EXPECT_NE(far[0].find("are rounded to"), std::string::npos) << far[0];
    }
}

/// So are steps in which rounding is more than gravity does, and only these.
TEST_P(Equivariant, StepsTooShortForSinglePrecisionAreTold) {
    const auto warnings_of = [](int substeps, double dt) {
        Scene scene = scene_of(kTiedBrick);
        scene.obstacles.clear();
        scene.substeps = substeps;
        scene.dt = dt;
        Warnings warnings;
        warn_of_start(Model(scene, warnings), warnings);
        return warnings;
    };
    const double dt = scene_of(kTiedBrick).dt;
    EXPECT_TRUE(warnings_of(128, dt).empty());
    const Warnings too_short = warnings_of(2048, dt);
    ASSERT_EQ(too_short.size(), 1U);
    EXPECT_NE(too_short[0].find("are so short that the rounding"), std::string::npos)
        << too_short[0];
    EXPECT_NE(too_short[0].find("(instead of 2048)"), std::string::npos) << too_short[0];
    for (const int substeps : {1, 2}) {
        const Warnings short_frame = warnings_of(substeps, 1e-6);
        ASSERT_EQ(short_frame.size(), 1U);
        EXPECT_NE(short_frame[0].find("scene.dt = 1e-06 s is too short for single precision: "
                                      "frames of 6e-05 s or more"),
                  std::string::npos)
            << short_frame[0];
    }
    EXPECT_TRUE(warnings_of(1, 6e-5).empty());
}

/// The unit of mass goes along, so that energies stay: cloth that rounding alone bends has energies
/// whose squares xpbd would otherwise lose below the least single-precision number.
TEST_P(Equivariant, LengthsScaledByPowersOfTwoChangeNoBit) {
    const auto run_scaled = [](double factor) {
        Scene scene = scene_of(kTiedBrick);
        const double squared = factor * factor;
        scene.gravity = factor * scene.gravity;
        Cloth& cloth = scene.cloths[0];
        cloth.density /= squared * squared;
        cloth.stretch.stiffness /= squared;
        scene.attachments[0].stiffness /= squared;
        Solid& solid = scene.solids[0];
        solid.density /= squared * squared * factor;
        solid.material.young /= squared * factor;
        for (Transform* body : {&cloth.transform, &solid.transform}) {
            body->scale = factor * body->scale;
            body->translate = factor * body->translate;
        }
        ManualRun run(scene);
        const auto start = scaled(positions(run), 1.0 / factor);
        run.run(kFrames);
        const auto end = scaled(positions(run), 1.0 / factor);
        EXPECT_GT(difference(start, end), 0.05) << "it has slid";
        return end;
    };
    const auto metres = run_scaled(1.0);
    EXPECT_EQ(metres, run_scaled(std::pow(2.0, -10)));
    EXPECT_EQ(metres, run_scaled(std::pow(2.0, 10)));
}

INSTANTIATE_TEST_SUITE_P(Methods, Equivariant, kMethods, name_of_method);

}  // namespace
}  // namespace weft::test
