#include "simulation/solver/xpbd.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "simulation/families/convert.h"
#include "simulation/scene/read_scene.h"
#include "tests/simulation/run/manual_run.h"
#include "tests/simulation/run/test_scenes.h"
#include "tests/simulation/solver/reference.h"

namespace weft::test {
namespace {

const std::string kOnBall = R"(
[scene]
frames = 1
dt = 0.02
substeps = 4
[solver]
iterations = 5
[[cloth]]
grid = { size = [1.0, 1.5], resolution = [12, 24] }
rotate = [1.0, 0.0, 1.0, 10.0]
translate = [0.0, 0.62, 0.0]
density = 0.2
stretch = { stiffness = 5.0e3 }
bend = { stiffness = 1.0e-2 }
damping = 0.5
pins = { corners = ["x-z-"] }
[[obstacle]]
shape = "sphere"
center = [0.0, 0.5, 0.0]
radius = 0.14
friction = 0.4
motion = { velocity = [1.0, 0.5, 0.0], angular_velocity = 360.0 }
[[obstacle]]
shape = "plane"
point = [0.0, 0.5, 0.0]
normal = [0.1, 1.0, 0.2]
thickness = 0.002
)";

/// A solid that hangs from a corner and falls on a plane, with a membrane tied to it.
const std::string kOnPlane = R"(
[scene]
frames = 1
dt = 0.02
substeps = 4
[solver]
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
young = 1.0e5
poisson = 0.4
damping = 0.5
pins = { corners = ["x-y+z-"] }
[[attachment]]
a = "film"
b = "brick"
corners = ["x-z-", "x+z-"]
stiffness = 1.0e3
[[obstacle]]
shape = "plane"
point = [0.0, 0.5, 0.0]
friction = 0.3
motion = { velocity = [0.2, 1.0, 0.0] }
)";

/// Woven cloth across its threads.
const std::string kWeaveOnBall = R"(
[scene]
frames = 1
dt = 0.02
substeps = 4
[solver]
iterations = 5
[[cloth]]
grid = { size = [1.0, 1.5], resolution = [12, 24] }
rotate = [1.0, 0.0, 1.0, 10.0]
translate = [0.0, 0.62, 0.0]
density = 0.2
woven = { warp = 2.0e3, weft = 4.0e2, shear = 30.0, direction = [1.0, 0.0, 2.0] }
bend = { stiffness = 1.0e-2 }
damping = 0.5
pins = { corners = ["x-z-"] }
[[obstacle]]
shape = "sphere"
center = [0.0, 0.5, 0.0]
radius = 0.14
friction = 0.4
motion = { velocity = [1.0, 0.5, 0.0], angular_velocity = 360.0 }
)";

class XpbdReference : public testing::TestWithParam<const std::string*> {};

TEST_P(XpbdReference, EverySubstepIsThatOfAnIndependentImplementationInDoublePrecision) {
    const Scene scene = parse_scene(*GetParam(), "test.toml");
    ManualRun run(scene);
    double moved_most = 0.0;
    for (int substeps = 1; substeps <= 4; ++substeps) {
        run.reset();
        ReferenceXpbd reference(*run.model);
        run.run_substeps(substeps);
        for (int s = 0; s < substeps; ++s) reference.substep(s * run.model->h);
        for (std::size_t i = 0; i < reference.x.size(); ++i) {
            const Vec3 x = to_vec3((*run.model->positions)[i]);
            const Vec3 v = to_vec3((*run.model->velocities)[i]);
            ASSERT_LT(length(x - reference.x[i]), 2e-6 * substeps) << "vertex " << i;
            ASSERT_LT(length(v - reference.v[i]), 2e-6 * substeps / run.model->h) << "vertex " << i;
            moved_most = std::max(moved_most, length(v));
        }
    }
    EXPECT_GT(moved_most, 0.5) << "something happens";
}

INSTANTIATE_TEST_SUITE_P(Scenes, XpbdReference,
                         testing::Values(&kOnBall, &kOnPlane, &kWeaveOnBall));

/// The number of executions of every item of every launch in one step.
long items_of(const Step& step) {
    return std::accumulate(step.tasks().begin(), step.tasks().end(), 0L,
                           [](long sum, const Task& task) { return sum + task.items; });
}

TEST(Xpbd, EveryDivisionHasTheSameWork) {
    ManualRun run(parse_scene(kEverything, "test.toml"));
    const long items = items_of(run.solver->make_step(Partition::whole(run.strip_count())));
    for (int first = 1; first < run.strip_count(); ++first) {
        const int one[] = {first};
        EXPECT_EQ(items_of(run.solver->make_step(Partition::at(one, run.strip_count()))), items);
        for (int second = first + 1; second < run.strip_count(); ++second) {
            const int two[] = {first, second};
            EXPECT_EQ(items_of(run.solver->make_step(Partition::at(two, run.strip_count()))),
                      items);
        }
    }
}

TEST(Xpbd, RegionsOnlyWaitForTheirNeighboursAtTheCut) {
    ManualRun run(parse_scene(kSpringsOnly, "test.toml"));
    ASSERT_GE(run.strip_count(), 6);
    const int cuts[] = {2, 4};
    const Step step = run.solver->make_step(Partition::at(cuts, run.strip_count()));
    for (const Dependency& d : step.dependencies()) {
        const Task& from = step.tasks()[static_cast<std::size_t>(d.from)];
        const Task& to = step.tasks()[static_cast<std::size_t>(d.to)];
        EXPECT_LE(std::abs(static_cast<int>(from.region) - static_cast<int>(to.region)), 1);
    }
    std::set<RegionId> regions;
    for (const Task& task : step.tasks()) regions.insert(task.region);
    EXPECT_EQ(regions, (std::set{RegionId{0}, RegionId{1}, RegionId{2}}));
}

/// The kernels that a scene's bodies launch.
std::set<std::string_view> kernels_of(const std::string& scene) {
    ManualRun run(parse_scene(scene, "test.toml"));
    std::set<std::string_view> kernels;
    for (const TaskBody* body : run.solver->bodies()) {
        for (const Launch& launch : body->launches) kernels.insert(launch.kernel->name);
    }
    return kernels;
}

TEST(Xpbd, LaunchesTetrahedraAndMembranesOnlyWhereThereAreSome) {
    EXPECT_EQ(kernels_of(R"(
[scene]
frames = 1
dt = 0.01
[[solid]]
grid = { size = [1.0, 1.0, 1.0], resolution = [3, 3, 3] }
density = 1.0
young = 1.0
poisson = 0.0
)"),
              (std::set<std::string_view>{"predict", "project_tetrahedra", "update_velocities"}));
    const auto all = kernels_of(kSolids);
    for (const char* kernel :
         {"project_springs", "project_membranes", "project_tetrahedra", "project_hinges"}) {
        EXPECT_TRUE(all.contains(kernel)) << kernel;
    }
}

TEST(Xpbd, HasNoBodyLaunchOrBufferForWhatASceneDoesNotName) {
    ManualRun plain(parse_scene(kSpringsOnly, "test.toml"));
    std::set<std::string_view> kernels;
    for (const TaskBody* body : plain.solver->bodies()) {
        for (const Launch& launch : body->launches) {
            kernels.insert(launch.kernel->name);
            for (const Argument& argument : launch.arguments) {
                if (argument.buffer == nullptr) continue;
                EXPECT_EQ(argument.buffer->name().find("hinge"), std::string::npos);
            }
        }
    }
    EXPECT_EQ(kernels,
              (std::set<std::string_view>{"predict", "project_springs", "update_velocities"}));

    ManualRun all(parse_scene(kEverything, "test.toml"));
    for (const TaskBody* body : all.solver->bodies()) {
        for (const Launch& launch : body->launches) kernels.insert(launch.kernel->name);
    }
    for (const char* kernel :
         {"project_hinges", "move_pins", "update_damped_velocities", "push_out_of_sphere",
          "push_out_of_plane", "push_out_of_capsule", "push_out_of_box"}) {
        EXPECT_TRUE(kernels.contains(kernel)) << kernel;
    }
    EXPECT_FALSE(kernels.contains("copy_positions")) << "no body is free";
}

}  // namespace
}  // namespace weft::test
