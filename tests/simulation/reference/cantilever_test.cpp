// Solids at rest under a load, in double precision, against beam theory.

#include <gtest/gtest.h>

#include "simulation/families/convert.h"
#include "simulation/reference/newton.h"
#include "simulation/scene/read_scene.h"

namespace weft::test {
namespace {

constexpr double kLength = 1.0;
constexpr double kHeight = 0.2;
constexpr double kYoung = 4e8;
// The clamp also hinders the beam from growing thinner, which beam theory does not know: at 0.3 the
// beam is 3 % stiffer than the theory, without lateral contraction it is not.
constexpr double kPoisson = 0.0;
constexpr double kDensity = 1000.0;
constexpr double kGravity = 9.81;

/// A beam that is clamped at one end and bends under its own weight; in a step of a thousand
/// seconds, in which inertia vanishes. How far its free end sinks [m].
double deflection(int cells_across) {
    Scene scene = parse_scene(R"(
[scene]
frames = 1
dt = 1.0
[[solid]]
grid = { size = [1.0, 0.2, 0.2], resolution = [2, 2, 2] }
density = 1000.0
young = 4.0e8
poisson = 0.0
pins = { faces = ["x-"] }
)",
                              "test.toml");
    const int across = cells_across + 1;
    scene.solids[0].shape =
        BlockShape{{kLength, kHeight, kHeight}, {5 * cells_across + 1, across, across}};
    scene.dt = 1000.0;  // inertia vanishes
    Warnings warnings;
    Model model(scene, warnings);
    IncrementalPotential potential(model, 0.0);
    std::vector<Vec3> start;
    for (const float4& x : model.positions->span()) start.push_back(to_vec3(x));
    const Minimum minimum = minimise(potential, start);
    EXPECT_LT(minimum.certificate.relative_gap, kSolvedGap);

    double sum = 0.0;
    int count = 0;
    for (std::size_t v = 0; v < start.size(); ++v) {
        if (start[v].x < 0.5 * kLength - 1e-6) continue;
        sum += start[v].y - minimum.x[v].y;
        ++count;
    }
    EXPECT_EQ(count, across * across);
    return sum / count;
}

/// Timoshenko's beam: bending, and shear with the rectangle's factor.
TEST(Cantilever, TendsToBeamTheoryAsItIsRefined) {
    const double line_load = kDensity * kGravity * kHeight * kHeight;
    const double inertia = kHeight * kHeight * kHeight * kHeight / 12.0;
    const double shear_modulus = kYoung / (2.0 * (1.0 + kPoisson));
    const double factor = 10.0 * (1.0 + kPoisson) / (12.0 + 11.0 * kPoisson);
    const double expected =
        line_load * std::pow(kLength, 4) / (8.0 * kYoung * inertia) +
        line_load * kLength * kLength / (2.0 * factor * shear_modulus * kHeight * kHeight);

    const double coarse = deflection(2);
    const double middle = deflection(4);
    const double fine = deflection(8);
    // Linear tetrahedra are too stiff in bending; the error falls with the square of their size.
    EXPECT_LT(coarse, middle);
    EXPECT_LT(middle, fine);
    EXPECT_LT(fine, expected);
    EXPECT_NEAR(fine, expected, 0.1 * expected);
    const double limit = fine + (fine - middle) / 3.0;
    EXPECT_NEAR(limit, expected, 0.02 * expected);
    RecordProperty("deflections", std::to_string(coarse) + " " + std::to_string(middle) + " " +
                                      std::to_string(fine) + " of " + std::to_string(expected));
}

}  // namespace
}  // namespace weft::test
