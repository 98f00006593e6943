#include "simulation/families/woven/woven.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

#include "runtime/error.h"
#include "simulation/families/convert.h"
#include "simulation/reference/incremental_potential.h"
#include "simulation/scene/elements/woven.h"
#include "simulation/scene/read_scene.h"
#include "tests/simulation/run/manual_run.h"

namespace weft::test {
namespace {

constexpr double kWidth = 0.2;   ///< [m] along x
constexpr double kLength = 0.4;  ///< [m] along z, in which it is pulled
constexpr int kAcross = 5;
constexpr int kAlong = 9;
constexpr double kShear = 12.0;  ///< [N/m]

/// A strip without gravity whose two ends are held.
Scene strip(Vec3 direction, double warp, double weft) {
    Scene scene = parse_scene(R"(
[scene]
frames = 1
dt = 0.02
substeps = 4
gravity = [0.0, 0.0, 0.0]
[solver]
iterations = 20
[[cloth]]
name = "strip"
grid = { size = [0.2, 0.4], resolution = [5, 9] }
density = 0.2
woven = { warp = 1.0, weft = 1.0, shear = 1.0 }
damping = 4.0
[[cloth.pins]]
box = [[-1.0, -1.0, -0.21], [1.0, 1.0, -0.19]]
[[cloth.pins]]
box = [[-1.0, -1.0, 0.19], [1.0, 1.0, 0.21]]
)",
                              "strip.toml");
    scene.cloths[0].elements.set(Woven{warp, weft, kShear, direction});
    return scene;
}

struct Pull {
    const char* name;
    Vec3 direction;  ///< of the warp
    double warp, weft;
    double force;          ///< per width at rest [N/m]
    double along, across;  ///< the closed form: length and width over those at rest
};

void PrintTo(const Pull& pull, std::ostream* out) { *out << pull.name; }

/// With q = p / (2 a): see kernels/energies/woven.h.
Pull bias_pull(double q) {
    const double k = 60.0;
    const double s = 1.0 / (1.0 - q / k);
    const double a = std::sqrt(s * s + q / kShear);
    return {"Bias", {1, 0, 1}, k, k, 2.0 * a * q, a, std::sqrt(s * s - q / kShear)};
}

const Pull kPulls[] = {
    {"Warp", {0, 0, 1}, 80.0, 30.0, 16.0, 1.2, 1.0},
    {"Weft", {1, 0, 0}, 80.0, 30.0, 6.0, 1.2, 1.0},
    bias_pull(3.0),
};

Vec3 stretched(Vec3 x, const Pull& pull) { return {pull.across * x.x, x.y, pull.along * x.z}; }

/// At the closed form no vertex feels a force but those of the ends, which are held with the pull.
class StripForces : public testing::TestWithParam<Pull> {};

TEST_P(StripForces, BalanceAtTheClosedForm) {
    const Pull& pull = GetParam();
    Warnings warnings;
    const Model model(strip(pull.direction, pull.warp, pull.weft), warnings);
    const auto& family = *model.find<WovenCloth>();
    std::vector<Vec3> forces(static_cast<std::size_t>(model.vertex_count()));
    for (int t = 0; t < family.count(); ++t) {
        std::array<Vec3, 3> x, gradient;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto v = static_cast<std::size_t>(family.corners(t)[k]);
            x[k] = stretched(to_vec3((*model.positions)[v]), pull);
        }
        family.gradient(t, x.data(), gradient.data());
        for (std::size_t k = 0; k < 3; ++k) {
            Vec3& at = forces[static_cast<std::size_t>(family.corners(t)[k])];
            at = at - gradient[k];
        }
    }
    double held = 0.0;
    for (std::size_t v = 0; v < forces.size(); ++v) {
        const Vec3 x = to_vec3((*model.positions)[v]);
        if (std::abs(x.z) < 0.49 * kLength) {
            EXPECT_LT(length(forces[v]), 1e-5 * pull.force * kWidth);
        } else if (x.z > 0.0) {
            held -= forces[v].z;
        }
    }
    EXPECT_NEAR(held, pull.force * kWidth, 1e-5 * pull.force * kWidth);
}

std::string name_of(const testing::TestParamInfo<Pull>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Pulls, StripForces, testing::ValuesIn(kPulls), name_of);

/// Ends held where the closed form has them; all between them thrown about, and let go.
class StripAtRest : public testing::TestWithParam<std::tuple<Method, Pull>> {};

TEST_P(StripAtRest, LiesWhereTheClosedFormSays) {
    const auto& [method, pull] = GetParam();
    Scene scene = strip(pull.direction, pull.warp, pull.weft);
    scene.solver.method = method;
    ManualRun run(scene);
    auto& x = *run.model->positions;
    std::mt19937 random(3);
    const auto noise = [&] { return 0.02 * (static_cast<double>(random() % 2001) / 1000.0 - 1.0); };
    std::vector<Vec3> expected;
    for (float4& at : x.span()) {
        expected.push_back(stretched(to_vec3(at), pull));
        const bool held = at.w == 0.0f;
        const Vec3 thrown = held ? Vec3{} : Vec3{noise(), noise(), noise()};
        at = to_float4(expected.back() + thrown, static_cast<double>(at.w));
    }
    run.changed(x);
    run.run(150);
    for (std::size_t v = 0; v < expected.size(); ++v) {
        EXPECT_LT(length(to_vec3(x[v]) - expected[v]), 2e-3 * kLength) << v;
    }
    const double s = kWidth * kLength;
    const auto& family = *run.model->find<WovenCloth>();
    std::vector<float4> exact;
    for (const Vec3& at : expected) exact.push_back(to_float4(at));
    EXPECT_NEAR(family.total_energy(x.span()), family.total_energy(exact), 1e-3 * pull.force * s);
}

INSTANTIATE_TEST_SUITE_P(Solvers, StripAtRest,
                         testing::Combine(testing::Values(Method::kXpbd, Method::kVbd,
                                                          Method::kSosd, Method::kJpgd,
                                                          Method::kNewton),
                                          testing::ValuesIn(kPulls)),
                         [](const auto& given) {
                             return std::string(name_of(std::get<0>(given.param))) +
                                    std::get<1>(given.param).name;
                         });

// ---- where the warp runs ----

/// The energy of a model after all positions were stretched by `factor` along one direction.
double energy_along(const Model& model, Vec3 direction, double factor) {
    const Vec3 d = normalized(direction);
    std::vector<float4> x;
    for (const float4& at : model.positions->span()) {
        const Vec3 p = to_vec3(at);
        x.push_back(to_float4(p + ((factor - 1.0) * dot(p, d)) * d));
    }
    return model.find<WovenCloth>()->total_energy(x);
}

Scene grid_scene(const std::string& woven) {
    return parse_scene(
        "[scene]\nframes = 1\ndt = 0.01\n[[cloth]]\nname = \"sheet\"\n"
        "grid = { size = [0.6, 0.5], resolution = [5, 4] }\ndensity = 0.2\nwoven = {"
        " warp = 70.0, weft = 20.0, shear = 5.0" +
            woven + " }\n",
        "sheet.toml");
}

TEST(WarpDirection, OfAGridIsItsFirstAxisHoweverItIsTurned) {
    Scene scene = grid_scene("");
    scene.cloths[0].transform.rotations = {{{1.0, 2.0, -1.0}, 50.0}};
    scene.cloths[0].transform.translate = {1.0, 0.0, -2.0};
    const Mat3 turn = rotation_matrix({1.0, 2.0, -1.0}, 50.0);
    Warnings warnings;
    const Model model(scene, warnings);
    const double strain = 0.1;
    const double size = 0.5 * strain * strain * 0.6 * 0.5;
    EXPECT_NEAR(energy_along(model, turn * Vec3{1, 0, 0}, 1.0 + strain), 70.0 * size, 1e-4);
    EXPECT_NEAR(energy_along(model, turn * Vec3{0, 0, 1}, 1.0 + strain), 20.0 * size, 1e-4);
}

TEST(WarpDirection, OfTheSceneIsLaidIntoTheCloth) {
    Warnings warnings;
    const Model model(grid_scene(", direction = [0.0, 3.0, 0.5]"), warnings);
    const double size = 0.5 * 0.01 * 0.6 * 0.5;
    EXPECT_NEAR(energy_along(model, {0, 0, 1}, 1.1), 70.0 * size, 1e-4);
    EXPECT_NEAR(energy_along(model, {1, 0, 0}, 1.1), 20.0 * size, 1e-4);
}

/// Every triangle's own: the cone is unrolled without stretching anywhere.
TEST(WarpDirection, OfACylinderRunsFromTopToBottom) {
    Scene scene = grid_scene("");
    scene.cloths[0].shape = CylinderShape{{0.3, 0.5}, 0.7, {24, 6}};
    Warnings warnings;
    const Model model(scene, warnings);
    const auto& family = *model.find<WovenCloth>();
    for (int t = 0; t < family.count(); ++t) {
        Vec3 warp;
        for (int k = 0; k < 3; ++k) {
            const auto v = static_cast<std::size_t>(family.corners(t)[static_cast<std::size_t>(k)]);
            warp = warp + family.shape_gradient(t, k)[0] * to_vec3((*model.positions)[v]);
        }
        // The side's slope: 0.2 m outwards over 0.7 m; 24 sides are flat.
        EXPECT_NEAR(length(warp), 1.0, 1e-5);
        EXPECT_NEAR(warp.y, -0.7 / std::hypot(0.7, 0.2 * std::cos(std::numbers::pi / 24.0)), 1e-5);
    }
}

class WovenMesh : public testing::Test {
protected:
    ~WovenMesh() override { std::filesystem::remove(path_); }

    /// Two triangles of a square of 1 m in the x-z plane, with texture coordinates or none.
    Scene scene_with(const std::string& texture, const std::string& faces,
                     const std::string& woven = "") {
        std::ofstream(path_) << "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\n" << texture << faces;
        Scene scene = grid_scene(woven);
        scene.cloths[0].shape = MeshFile{path_.string()};
        return scene;
    }
    double energy(const Scene& scene, Vec3 direction) {
        Warnings warnings;
        return energy_along(Model(scene, warnings), direction, 1.1);
    }
    std::string message_of(const Scene& scene) {
        try {
            Warnings warnings;
            const Model model(scene, warnings);
        } catch (const UserError& error) {
            return error.what();
        }
        return "no error";
    }

    std::filesystem::path path_ = std::filesystem::temp_directory_path() /
                                  ("woven-" + std::to_string(std::random_device{}()) + ".obj");
    const std::string kFaces = "f 1/1 3/3 2/2\nf 1/1 4/4 3/3\n";
};

TEST_F(WovenMesh, HasItsWarpAlongU) {
    // u along -z, and v along x, of any scale.
    const Scene turned = scene_with("vt 0 0\nvt 0 2\nvt -2 2\nvt -2 0\n", kFaces);
    EXPECT_NEAR(energy(turned, {0, 0, 1}), 0.5 * 70.0 * 0.01, 1e-4);
    EXPECT_NEAR(energy(turned, {1, 0, 0}), 0.5 * 20.0 * 0.01, 1e-4);
    const Scene bias = scene_with("vt 0 0\nvt 1 1\nvt 2 0\nvt 1 -1\n", kFaces);
    EXPECT_NEAR(energy(bias, {1, 0, 1}), 0.5 * 70.0 * 0.01, 1e-4);
    EXPECT_NEAR(energy(bias, {1, 0, -1}), 0.5 * 20.0 * 0.01, 1e-4);
}

TEST_F(WovenMesh, SaysWhatIsMissing) {
    const std::string plain = "f 1 3 2\nf 1 4 3\n";
    EXPECT_NE(message_of(scene_with("", plain))
                  .find("woven cloth 'sheet': " + path_.string() +
                        " has no texture coordinates to say where the warp runs; set "
                        "woven.direction = [x, y, z]"),
              std::string::npos);
    EXPECT_EQ(message_of(scene_with("", plain, ", direction = [1.0, 0.0, 0.0]")), "no error");
    EXPECT_NE(message_of(scene_with("", plain, ", direction = [0.0, 1.0, 0.0]"))
                  .find("triangle 1 (counted from 1): the warp's direction is perpendicular"),
              std::string::npos);
    EXPECT_NE(message_of(scene_with("vt 0 0\nvt 1 0\nvt 1 1\nvt 1 1\n",
                                    "f 1/1 3/3 2/2\nf 1/1 4/4 "
                                    "3/3\n"))
                  .find("triangle 2 (counted from 1): its texture coordinates have no area"),
              std::string::npos);
}

}  // namespace
}  // namespace weft::test
