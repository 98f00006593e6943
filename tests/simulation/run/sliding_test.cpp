// Solids on slopes of about their angle of friction, in as many substeps as they get by default.

#include <gtest/gtest.h>

#include <cmath>

#include "simulation/scene/read_scene.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

const std::string kBlock = R"(
[scene]
frames = 1
dt = 0.01
[[obstacle]]
shape = "box"
center = [0.0, -0.05, 0.0]
size = [3.0, 0.1, 3.0]
friction = 0.5
thickness = 0.003
[[solid]]
name = "block"
grid = { size = [0.1, 0.05, 0.1], resolution = [4, 3, 4] }
translate = [-0.3, 0.0282, 0.0]
density = 500.0
young = 1.0e6
poisson = 0.3
)";

constexpr double kGravity = 9.81, kFriction = 0.5;

class SlidingBody : public testing::TestWithParam<Method> {
protected:
    /// Its speed after 0.55 s [m/s], and what Coulomb's law says.
    struct Speeds {
        double found, expected;
    };
    /// steepness: the slope's tangent, in parts of friction's
    Speeds speeds(double steepness, bool in_contact) const {
        Scene scene = parse_scene(kBlock, "test.toml");
        scene.solver.method = GetParam();
        if (in_contact) scene.contact = Contact{};
        const double angle = std::atan(kFriction * steepness);
        scene.gravity = {kGravity * std::sin(angle), -kGravity * std::cos(angle), 0.0};
        ManualRun run(scene);
        const auto place = [&] { return momentum_of(run, 0, run.model->vertex_count()).place; };
        run.run(50);
        const Vec3 before = place();
        run.run(10);
        const double rubbed = kFriction * std::cos(angle);
        return {length(place() - before) / 0.1,
                std::max(0.0, 0.55 * kGravity * (std::sin(angle) - rubbed))};
    }
};

/// It crept by up to 8 mm/s before, too.
TEST_P(SlidingBody, StaysBelowItsAngleOfFriction) {
    for (const bool in_contact : {false, true}) {
        EXPECT_LT(speeds(0.9, in_contact).found, 0.004) << in_contact;
        EXPECT_LT(speeds(0.97, in_contact).found, 0.015) << in_contact;
    }
}

/// It stayed up to 1.2 times friction's tangent.
TEST_P(SlidingBody, SlidesAsCoulombsLawSaysAboveIt) {
    for (const bool in_contact : {false, true}) {
        for (const double steepness : {1.1, 1.2, 2.0}) {
            const Speeds v = speeds(steepness, in_contact);
            EXPECT_NEAR(v.found, v.expected, 0.08 * v.expected) << steepness << " " << in_contact;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Solvers, SlidingBody,
                         testing::Values(Method::kXpbd, Method::kVbd, Method::kSosd, Method::kJpgd,
                                         Method::kNewton),
                         name_of_method);

}  // namespace
}  // namespace weft::test
