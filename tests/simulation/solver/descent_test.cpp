// The methods that minimise the step's incremental potential do so, down to its minimum.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "simulation/families/convert.h"
#include "simulation/reference/newton.h"
#include "simulation/scene/read_scene.h"
#include "tests/simulation/run/manual_run.h"

namespace weft::test {
namespace {

const std::string kSheet = R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 1
[[cloth]]
grid = { size = [1.0, 1.4], resolution = [15, 21] }
density = 0.2
stretch = { stiffness = 300.0 }
bend = { stiffness = 1.0e-2 }
pins = { corners = ["x-z-", "x+z-"] }
)";

/// A clamped beam of a soft solid, and a membrane that is tied to it.
const std::string kBeam = R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 1
[[cloth]]
name = "film"
grid = { size = [0.8, 0.8], resolution = [9, 9] }
translate = [0.0, 0.15, 0.4]
density = 0.3
membrane = { young = 1.0e5, poisson = 0.3, thickness = 1.0e-3 }
[[solid]]
name = "beam"
grid = { size = [1.0, 0.3, 0.3], resolution = [11, 4, 4] }
density = 500.0
young = 2.0e4
poisson = 0.3
pins = { faces = ["x-"] }
[[attachment]]
a = "film"
b = "beam"
corners = ["x-z-", "x+z-"]
stiffness = 100.0
)";

/// A sheet of triangle membranes that bends.
const std::string kFilm = R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 1
[[cloth]]
grid = { size = [1.0, 1.4], resolution = [15, 21] }
density = 0.2
membrane = { young = 3.0e5, poisson = 0.3, thickness = 1.0e-3 }
bend = { stiffness = 1.0e-2 }
pins = { corners = ["x-z-", "x+z-"] }
)";

/// A tube that is curved at rest.
const std::string kTube = R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 1
[[cloth]]
cylinder = { radius = [0.3, 0.4], height = 0.6, resolution = [14, 10] }
density = 0.2
stretch = { stiffness = 100.0 }
bend = { stiffness = 2.0e-1 }
pins = { rims = ["top"] }
)";

/// One substep of a scene that is stretched, bent and sheared at its start.
class OneStep {
public:
    OneStep(Scene scene, Method method, int iterations)
        : run_(with(std::move(scene), method, iterations)) {
        auto& x = *run_.model->positions;
        for (float4& p : x.span()) {
            p = {1.1f * p.x + 0.05f * p.z, 0.1f * p.x * p.x - 0.05f * p.z,
                 0.95f * p.z + 0.05f * p.x * p.z, p.w};
        }
        run_.changed(x);
        potential_ = std::make_unique<IncrementalPotential>(*run_.model, 0.0);
    }
    double start_energy() const { return potential_->energy(potential_->predicted()); }
    Minimum minimum() { return minimise(*potential_, potential_->predicted()); }
    double energy_after_run() {
        run_.run_substeps(1);
        std::vector<Vec3> x;
        for (const float4& p : run_.model->positions->span()) x.push_back(to_vec3(p));
        return potential_->energy(x);
    }

private:
    static Scene with(Scene scene, Method method, int iterations) {
        scene.solver.method = method;
        scene.solver.iterations = iterations;
        return scene;
    }
    ManualRun run_;
    std::unique_ptr<IncrementalPotential> potential_;
};

class Descent : public testing::TestWithParam<std::tuple<Method, const std::string*>> {};

TEST_P(Descent, LowersTheEnergyAndReachesItsMinimum) {
    const auto [method, text] = GetParam();
    const Scene scene = parse_scene(*text, "test.toml");
    OneStep reference(scene, method, 1);
    const Minimum minimum = reference.minimum();
    ASSERT_LT(minimum.certificate.relative_gap, kSolvedGap);
    const double whole = minimum.start_energy - minimum.energy;
    ASSERT_GT(whole, 0.1 * minimum.start_energy) << "there is something to do";
    double last = 1.0;
    for (const int iterations : {1, 2, 4, 8, 16, 32, 64, 128, 256, 512}) {
        if (method == Method::kNewton && iterations > 32) break;
        const double energy = OneStep(scene, method, iterations).energy_after_run();
        const double error = (energy - minimum.energy) / whole;
        EXPECT_GT(error, -1e-6) << "nothing is below the minimum";
        // JPGD goes back to its last checkpoint where a step length was too large: a run that ends
        // just then may be no better than its start. It does so early, or not at all.
        const bool may_be_back = method == Method::kJpgd && iterations > 4 && iterations < 32;
        const double bound = may_be_back ? 1.0 : std::min(last, 0.99);
        EXPECT_LT(error, bound + 1e-6) << iterations << " iterations";
        last = error;
        RecordProperty("after_" + std::to_string(iterations), std::to_string(error));
    }
    EXPECT_LT(last, 1e-3);
}

std::string name_of_method(
    const testing::TestParamInfo<std::tuple<Method, const std::string*>>& info) {
    const auto [method, scene] = info.param;
    const char* body = scene == &kSheet  ? "Sheet"
                       : scene == &kFilm ? "Film"
                       : scene == &kTube ? "Tube"
                                         : "Beam";
    return std::string(name_of(method)) + body;
}

INSTANTIATE_TEST_SUITE_P(Methods, Descent,
                         testing::Combine(testing::Values(Method::kVbd, Method::kSosd,
                                                          Method::kJpgd, Method::kNewton),
                                          testing::Values(&kSheet, &kFilm, &kBeam, &kTube)),
                         name_of_method);

/// The scenes that ship, with fewer vertices and without what is no part of E.
TEST(ShippedScenes, EverySolverLowersTheEnergyOfAStep) {
    int scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(WEFT_SCENES)) {
        if (entry.path().extension() != ".toml") continue;
        ++scenes;
        Scene scene = read_scene(entry.path().string(), {{"scene.size=400", "--set"}});
        if (scene.contact) continue;  // not every solver knows it
        scene.obstacles.clear();
        for (const std::string& name : method_names()) {
            SCOPED_TRACE(entry.path().filename().string() + ", " + name);
            const Method method = method_named(name);
            const double start = OneStep(scene, method, 1).start_energy();
            const bool descends =
                method == Method::kVbd || method == Method::kSosd || method == Method::kNewton;
            double last = start;
            // XPBD projects, and does not descend: its first iterations may raise E.
            for (int iterations = method == Method::kXpbd ? 16 : 1; iterations <= 64;
                 iterations *= 4) {
                const double energy = OneStep(scene, method, iterations).energy_after_run();
                if (method == Method::kNewton && iterations > 1)
                    EXPECT_LT(energy, last + 1e-5 * start) << "it is at the minimum";
                else
                    EXPECT_LT(energy, descends ? last : start) << iterations << " iterations";
                last = energy;
            }
        }
    }
    EXPECT_GE(scenes, 5);
}

}  // namespace
}  // namespace weft::test
