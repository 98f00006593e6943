// Steps in contact: every method that knows contacts goes down to the minimum of the step's energy,
// with the contacts that it found at its begin, in double precision.

#include <gtest/gtest.h>

#include "simulation/contact/response.h"
#include "simulation/families/convert.h"
#include "simulation/reference/newton.h"
#include "simulation/scene/method.h"
#include "simulation/scene/read_scene.h"
#include "tests/simulation/run/manual_run.h"

namespace weft::test {
namespace {

/// A sheet that comes down on another one, which hangs at its sides, within their range.
const std::string kSheets = R"(
[scene]
frames = 1
dt = 0.002
substeps = 1
[contact]
thickness = 0.02
[[cloth]]
name = "low"
grid = { size = [0.5, 0.5], resolution = [9, 9] }
density = 0.2
stretch = { stiffness = 300.0 }
pins = { edges = ["x-", "x+"] }
[[cloth]]
name = "high"
grid = { size = [0.3, 0.3], resolution = [7, 7] }
rotate = [0, 1, 0, 20]
translate = [0.01, 0.014, 0.02]
density = 0.2
stretch = { stiffness = 300.0 }
)";

/// One substep.
class Step {
public:
    Step(Method method, int iterations) : run_(scene_of(method, iterations)) {
        for (std::size_t v = 0; v < run_.model->positions->count(); ++v) {
            const bool is_high = run_.model->scene_vertex(static_cast<int>(v)) >= 81;
            if (is_high) (*run_.model->velocities)[v].y = -1.5f;
        }
        run_.changed(*run_.model->velocities);
    }

    /// Before it has run. contacts: that it will find
    IncrementalPotential potential(std::vector<FrozenContact> contacts) const {
        return {*run_.model, 0.0, std::move(contacts)};
    }
    void run() { run_.run_substeps(1); }
    std::vector<FrozenContact> contacts() {
        return frozen_contacts(run_.solver->contact()->rows(), run_.model->positions->span());
    }
    std::vector<Vec3> positions() const {
        std::vector<Vec3> x;
        for (const float4& p : run_.model->positions->span()) x.push_back(to_vec3(p));
        return x;
    }

private:
    static Scene scene_of(Method method, int iterations) {
        Scene scene = parse_scene(kSheets, "test.toml");
        scene.solver.method = method;
        scene.solver.iterations = iterations;
        return scene;
    }
    ManualRun run_;
};

class ContactDescent : public testing::TestWithParam<Method> {};

TEST_P(ContactDescent, ReachesTheMinimum) {
    Step first(GetParam(), 1);
    first.run();
    const Step start(GetParam(), 1);
    IncrementalPotential potential = start.potential(first.contacts());
    const Minimum minimum = minimise(potential, potential.predicted());
    ASSERT_LT(minimum.certificate.relative_gap, kSolvedGap);
    const double whole = minimum.start_energy - minimum.energy;
    ASSERT_GT(whole, 0.1 * minimum.start_energy) << "there is something to do";
    double last = 1e30;
    for (const int iterations : {1, 4, 16, 64, 256, 1024}) {
        Step step(GetParam(), iterations);
        step.run();
        const double error = (potential.energy(step.positions()) - minimum.energy) / whole;
        EXPECT_GT(error, -1e-6) << "nothing is below the minimum";
        EXPECT_LT(error, last + 1e-6) << iterations;
        last = error;
        RecordProperty("after_" + std::to_string(iterations), std::to_string(error));
    }
    EXPECT_LT(last, 2e-5);
}

INSTANTIATE_TEST_SUITE_P(Methods, ContactDescent,
                         testing::Values(Method::kVbd, Method::kSosd, Method::kJpgd, Method::kXpbd),
                         [](const auto& given) { return std::string(name_of(given.param)); });

}  // namespace
}  // namespace weft::test
