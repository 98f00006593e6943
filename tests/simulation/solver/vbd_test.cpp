#include "simulation/solver/vbd.h"

#include <gtest/gtest.h>

#include "simulation/families/convert.h"
#include "simulation/scene/read_scene.h"
#include "tests/simulation/run/manual_run.h"
#include "tests/simulation/solver/reference_vbd.h"

namespace weft::test {
namespace {

const std::string kSheet = R"(
[scene]
frames = 1
dt = 0.02
substeps = 4
[solver]
method = "vbd"
iterations = 5
[[cloth]]
grid = { size = [1.0, 1.5], resolution = [12, 24] }
rotate = [1.0, 0.0, 1.0, 10.0]
translate = [0.0, 0.62, 0.0]
density = 0.2
stretch = { stiffness = 200.0 }
bend = { stiffness = 1.0e-2 }
damping = 0.5
pins = { corners = ["x-z-"] }
[[obstacle]]
shape = "plane"
point = [0.0, 0.6, 0.0]
normal = [0.1, 1.0, 0.2]
thickness = 0.002
)";

/// A solid that hangs from a corner, with a membrane tied to it.
const std::string kBrick = R"(
[scene]
frames = 1
dt = 0.06
substeps = 4
[solver]
method = "vbd"
iterations = 5
[[cloth]]
name = "film"
grid = { size = [0.4, 0.5], resolution = [6, 8] }
rotate = [1.0, 0.0, 1.0, 10.0]
translate = [0.0, 0.82, 0.35]
density = 0.2
membrane = { young = 1.0e5, poisson = 0.3, thickness = 1.0e-3 }
bend = { stiffness = 1.0e-2 }
[[solid]]
name = "brick"
grid = { size = [0.3, 0.2, 0.4], resolution = [5, 4, 6] }
rotate = [1.0, 0.0, 1.0, 20.0]
translate = [0.0, 0.63, 0.0]
density = 500.0
young = 2.0e4
poisson = 0.4
damping = 0.5
pins = { corners = ["x-y+z-"] }
[[attachment]]
a = "film"
b = "brick"
corners = ["x-z-", "x+z-"]
stiffness = 1.0e3
)";

class VbdReference : public testing::TestWithParam<const std::string*> {};

TEST_P(VbdReference, EverySubstepIsThatOfAnIndependentImplementationInDoublePrecision) {
    ManualRun run(parse_scene(*GetParam(), "test.toml"));
    double moved_most = 0.0;
    double off_most = 0.0;
    for (int substeps = 1; substeps <= 4; ++substeps) {
        run.reset();
        ReferenceVbd reference(*run.model);
        run.run_substeps(substeps);
        for (int s = 0; s < substeps; ++s) reference.substep(s * run.model->h);
        for (std::size_t i = 0; i < reference.x.size(); ++i) {
            const Vec3 x = to_vec3((*run.model->positions)[i]);
            const Vec3 v = to_vec3((*run.model->velocities)[i]);
            off_most = std::max(off_most, length(x - reference.x[i]) / substeps);
            ASSERT_LT(length(x - reference.x[i]), 2e-6 * substeps)
                << "vertex " << i << ", substep " << substeps;
            ASSERT_LT(length(v - reference.v[i]), 2e-6 * substeps / run.model->h) << "vertex " << i;
            moved_most = std::max(moved_most, length(v));
        }
    }
    EXPECT_GT(moved_most, 0.5) << "something happens";
    RecordProperty("off_most", std::to_string(off_most));
}

INSTANTIATE_TEST_SUITE_P(Scenes, VbdReference, testing::Values(&kSheet, &kBrick));

}  // namespace
}  // namespace weft::test
