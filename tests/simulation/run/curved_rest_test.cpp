// Cloth that is curved at rest, and cloth whose rest shape is a file of its own.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "simulation/checks/start_checks.h"
#include "simulation/families/convert.h"
#include "simulation/families/curved_hinges/curved_hinges.h"
#include "simulation/families/hinges/hinges.h"
#include "simulation/families/springs/springs.h"
#include "simulation/reference/incremental_potential.h"
#include "simulation/scene/read_scene.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

constexpr double kRadius = 0.05;
constexpr int kAcross = 13;
constexpr int kAlong = 17;

/// Half a tube along z, its edges 0.1 m apart; curved = false: the same sheet, laid flat.
std::string half_tube(bool curved) {
    const std::string path = testing::TempDir() + (curved ? "half_tube.obj" : "half_tube_flat.obj");
    std::ofstream file(path);
    file.precision(17);
    for (int k = 0; k < kAlong; ++k) {
        for (int i = 0; i < kAcross; ++i) {
            const double angle = std::numbers::pi * (static_cast<double>(i) / (kAcross - 1) - 0.5);
            const Vec3 x = curved ? kRadius * Vec3{std::sin(angle), std::cos(angle), 0.0}
                                  : Vec3{kRadius * angle, 0.0, 0.0};
            file << "v " << x.x << ' ' << x.y << ' ' << 0.01 * k << '\n';
        }
    }
    for (int k = 0; k + 1 < kAlong; ++k) {
        for (int i = 1; i < kAcross; ++i) {
            const int a = k * kAcross + i;
            file << "f " << a << ' ' << a + kAcross << ' ' << a + 1 << '\n';
            file << "f " << a + 1 << ' ' << a + kAcross << ' ' << a + kAcross + 1 << '\n';
        }
    }
    return path;
}

Scene tube_scene(Method method, const std::string& mesh) {
    Scene scene = parse_scene(R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 4
gravity = [0.0, 0.0, 0.0]
[solver]
iterations = 20
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [2, 2] }
density = 0.2
stretch = { stiffness = 1.0e2 }
bend = { stiffness = 1.0e-3 }
damping = 4.0
)",
                              "test.toml");
    scene.solver.method = method;
    scene.cloths[0].shape = MeshFile{mesh};
    return scene;
}

/// Between the two straight edges, in the middle [m].
double width(const ManualRun& run) {
    const auto x = positions(run);
    const int row = kAlong / 2 * kAcross;
    return length(at(x, row) - at(x, row + kAcross - 1));
}

/// A strip of 0.4 m that is folded in its middle, over four edges along z.
std::string folded_strip(double degrees) {
    const std::string path = testing::TempDir() + "folded_strip.obj";
    std::ofstream file(path);
    file.precision(17);
    const double angle = degrees * std::numbers::pi / 180.0;
    for (int k = 0; k < 5; ++k) {
        const double z = 0.1 * k;
        file << "v -0.2 0 " << z << "\nv 0 0 " << z << "\nv " << 0.2 * std::cos(angle) << ' '
             << 0.2 * std::sin(angle) << ' ' << z << '\n';
    }
    for (int k = 0; k < 4; ++k) {
        for (int a = 3 * k + 1; a < 3 * k + 3; ++a) {
            file << "f " << a << ' ' << a + 3 << ' ' << a + 1 << '\n';
            file << "f " << a + 1 << ' ' << a + 3 << ' ' << a + 4 << '\n';
        }
    }
    return path;
}

TEST(FoldedShut, IsToldWhereRestIsFlat) {
    for (const bool is_flat : {true, false}) {
        for (const double degrees : {180.0, -180.0, 179.9, 90.0, 0.0}) {
            Scene scene = tube_scene(Method::kVbd, folded_strip(degrees));
            scene.cloths[0].bend->rest_is_flat = is_flat;
            Warnings warnings;
            warn_of_start(Model(scene, warnings), warnings);
            const bool is_told = is_flat && std::abs(degrees) == 180.0;
            ASSERT_EQ(warnings.size(), is_told ? 1U : 0U) << is_flat << ' ' << degrees;
            if (!is_told) continue;
            EXPECT_NE(warnings[0].find("by 180 degrees over 4 of its edges"), std::string::npos)
                << warnings[0];
        }
    }
}

class CurvedRest : public EverySolver {};

TEST_P(CurvedRest, HalfTubeKeepsItsRadius) {
    ManualRun run(tube_scene(GetParam(), half_tube(true)));
    const auto start = positions(run);
    run.run(60);
    EXPECT_NEAR(width(run), 2.0 * kRadius, 1e-5);
    EXPECT_LT(difference(positions(run), start), 1e-4);
}

TEST_P(CurvedRest, HalfTubeUnrollsWhereItsRestIsFlat) {
    Scene scene = tube_scene(GetParam(), half_tube(true));
    scene.cloths[0].bend->rest_is_flat = true;
    ManualRun run(scene);
    run.run(60);
    EXPECT_GT(width(run), 0.14);
}

/// Pressed flat, and even bent somewhat to the other side, it curls up again the way it was.
TEST_P(CurvedRest, PressedTubeComesBack) {
    ManualRun run(tube_scene(GetParam(), half_tube(true)));
    auto& x = *run.model->positions;
    for (float4& p : x.span()) {
        const double angle = std::atan2(static_cast<double>(p.x), static_cast<double>(p.y));
        const double arc = kRadius * angle;
        p = to_float4({arc, 4.0 * arc * arc, static_cast<double>(p.z)}, static_cast<double>(p.w));
    }
    run.changed(x);
    ASSERT_GT(width(run), 0.14);
    run.run(120);
    EXPECT_NEAR(width(run), 2.0 * kRadius, 0.003);
    const auto now = positions(run);
    const int row = kAlong / 2 * kAcross;
    EXPECT_GT(at(now, row + kAcross / 2).y, at(now, row).y + 0.03) << "the way it was";
}

/// Flat panels at rest: a tube is only their start.
TEST_P(CurvedRest, FlatPatternUnrolls) {
    Scene scene = tube_scene(GetParam(), half_tube(true));
    scene.cloths[0].shape = MeshFile{half_tube(true), half_tube(false)};
    ManualRun run(scene);
    EXPECT_EQ(run.model->find<CurvedHinges>(), nullptr);
    run.run(60);
    EXPECT_GT(width(run), 0.14);
}

/// The pattern's measures, whatever the mesh is placed as: an arc, not its chords.
TEST(Pattern, GivesLengthsAndMasses) {
    Scene scene = tube_scene(Method::kXpbd, half_tube(true));
    scene.cloths[0].shape = MeshFile{half_tube(true), half_tube(false)};
    scene.cloths[0].transform.scale = {2.0, 2.0, 2.0};
    Warnings warnings;
    const Model model(scene, warnings);
    double mass = 0.0;
    for (const double m : model.masses) mass += m;
    EXPECT_NEAR(mass, 0.2 * 4.0 * std::numbers::pi * kRadius * 0.01 * (kAlong - 1), 1e-9);
    int arcs = 0;
    const double arc = 2.0 * std::numbers::pi * kRadius / (kAcross - 1);
    const Springs& springs = *model.find<Springs>();
    for (int s = 0; s < springs.count(); ++s) {
        if (std::abs(springs.rest_length(s) - arc) < 1e-8) ++arcs;
    }
    EXPECT_EQ(arcs, (kAcross - 1) * kAlong);
}

/// Every hinge keeps to one of the two families, and both see the same folds.
TEST(CurvedHinges, AreThoseThatAreFolded) {
    Warnings warnings;
    const Model model(tube_scene(Method::kXpbd, half_tube(true)), warnings);
    // Along z; the facets between are flat.
    EXPECT_EQ(model.find<CurvedHinges>()->count(), (kAcross - 2) * (kAlong - 1));
    EXPECT_EQ(model.find<Hinges>()->count(),
              (kAcross - 1) * (kAlong - 2) + (kAcross - 1) * (kAlong - 1));
    // As much as rounded positions make of 1e-3 J.
    EXPECT_LT(model.find<CurvedHinges>()->total_energy(model.positions->span()), 1e-10);
}

TEST(CurvedHinges, DerivativesOfTheReferenceMatchDifferences) {
    Warnings warnings;
    const Model model(tube_scene(Method::kXpbd, half_tube(true)), warnings);
    const CurvedHinges& hinges = *model.find<CurvedHinges>();
    std::array<Vec3, 4> x{
        Vec3{0.0, 0.01, 0.002}, {0.012, 0.0, 0.001}, {0.004, 0.013, 0.0}, {0.008, -0.002, 0.014}};
    const auto number = [&](std::size_t k) -> double& {
        Vec3& corner = x[k / 3];
        return k % 3 == 0 ? corner.x : k % 3 == 1 ? corner.y : corner.z;
    };
    const auto part = [](Vec3 v, std::size_t k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; };
    std::array<Vec3, 4> gradient, ahead, behind;
    std::array<Mat3, 16> blocks;
    hinges.gradient(7, x.data(), gradient.data());
    hinges.hessian(7, x.data(), blocks.data());
    const double step = 1e-6;
    for (std::size_t k = 0; k < 12; ++k) {
        const double here = number(k);
        number(k) = here + step;
        const double above = hinges.energy(7, x.data());
        hinges.gradient(7, x.data(), ahead.data());
        number(k) = here - step;
        const double below = hinges.energy(7, x.data());
        hinges.gradient(7, x.data(), behind.data());
        number(k) = here;
        EXPECT_NEAR(part(gradient[k / 3], k % 3), (above - below) / (2.0 * step), 1e-6);
        for (std::size_t j = 0; j < 12; ++j) {
            const double slope = part(ahead[j / 3] - behind[j / 3], j % 3) / (2.0 * step);
            const double entry = part(blocks[4 * (j / 3) + k / 3].rows[j % 3], k % 3);
            EXPECT_NEAR(entry, slope, 1e-4 * (1.0 + std::abs(slope)));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, CurvedRest, kMethods, name_of_method);

}  // namespace
}  // namespace weft::test
