// Devices that work on iterates of their own: the same bits as on one, whatever the cut.

#include "simulation/solver/own_iterates.h"

#include <gtest/gtest.h>

#include <set>

#include "runtime/error.h"
#include "runtime/opencl/opencl_device.h"
#include "runtime/tbb/cpu_device.h"
#include "simulation/replay.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "tests/simulation/run/test_scenes.h"

namespace weft::test {
namespace {

constexpr int kFrames = 3;

using Devices = std::vector<std::unique_ptr<Device>>;

Devices cpus(int count) {
    Devices devices;
    for (int d = 0; d < count; ++d) devices.push_back(make_cpu_device(1, {}));
    return devices;
}

struct TestCase {
    Method method;
    const std::string* scene;
    int iterations = 3;
};

std::string name_of_case(const testing::TestParamInfo<TestCase>& info) {
    std::string name(name_of(info.param.method));
    const bool touches = info.param.scene == &kTouching;
    name += info.param.scene == &kSolids ? "Solids" : touches ? "Touching" : "Everything";
    return name + std::to_string(info.param.iterations);
}

class OwnIteratesOf : public testing::TestWithParam<TestCase> {
protected:
    OwnIteratesOf() : scene_(parse_scene(*GetParam().scene, "test.toml")) {
        scene_.solver.method = GetParam().method;
        scene_.solver.iterations = GetParam().iterations;
        strips_ = Model(scene_, warnings_).strips.count();
    }
    std::unique_ptr<Simulation> simulation(Devices devices, const Division& division,
                                           int iterates) {
        SimulationOptions options;
        options.division = division;
        options.iterates = iterates;
        options.calibrate = false;
        return std::make_unique<Simulation>(scene_, std::move(devices), options, warnings_);
    }
    std::string hash_of(Devices devices, const Division& division, int iterates) {
        const auto run = simulation(std::move(devices), division, iterates);
        for (int frame = 0; frame < kFrames; ++frame) run->advance();
        return run->hash();
    }
    std::string shared_hash() { return hash_of(cpus(1), Division{{strips_}}, 1); }

    Scene scene_;
    Warnings warnings_;
    int strips_ = 0;
};

TEST_P(OwnIteratesOf, EveryCutGivesTheSameBits) {
    const std::string expected = shared_hash();
    for (int cut = 0; cut <= strips_; ++cut) {
        EXPECT_EQ(hash_of(cpus(2), {{cut, strips_ - cut}}, 2), expected) << cut;
    }
}

TEST_P(OwnIteratesOf, ThreeDevicesOnTwoAndThreeIterates) {
    const std::string expected = shared_hash();
    for (const int iterates : {2, 3}) {
        EXPECT_EQ(hash_of(cpus(3), {{2, strips_ - 3, 1}}, iterates), expected) << iterates;
        EXPECT_EQ(hash_of(cpus(3), {{1, 1, strips_ - 2}}, iterates), expected) << iterates;
    }
}

/// Divided anew in every frame.
TEST_P(OwnIteratesOf, AsThePlannerDivides) {
    SimulationOptions options;
    options.plan = PlanKind::kExact;
    options.iterates = 2;
    Simulation run(scene_, cpus(2), options, warnings_);
    for (int frame = 0; frame < kFrames; ++frame) run.advance();
    EXPECT_EQ(run.hash(), shared_hash());
}

/// Fewer cases: each builds its kernels.
class OwnIteratesBesideOpenCl : public OwnIteratesOf {};

TEST_P(OwnIteratesBesideOpenCl, InMemoryOfItsOwn) {
    if (opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device here";
    Devices devices = cpus(1);
    DeviceOptions options;
    options.memory = MemoryModel::kDiscrete;
    for (auto& device : open_opencl_device(0, {}, options)) devices.push_back(std::move(device));
    const int half = strips_ / 2;
    EXPECT_EQ(hash_of(std::move(devices), {{half, strips_ - half}}, 2), shared_hash());
}

/// Tasks of the solver touch no other iterate than their part's: that is what it is for.
TEST_P(OwnIteratesOf, TasksKeepToTheirOwn) {
    Model model(scene_, warnings_);
    OwnIterates solver(model, make_solver(model), 3);
    const Partition partition = Partition::at(std::vector{strips_ / 3, strips_ / 2}, strips_);
    const Step step = solver.make_step(partition.spread(3));
    const int exchange = static_cast<int>(solver.kinds().size()) - 1;
    int exchanges = 0;
    std::set<int> seen;
    for (const Task& task : step.tasks()) {
        exchanges += task.body->kind == exchange ? 1 : 0;
        if (task.body->kind == exchange) continue;
        for (const Access& access : task.accesses) {
            const std::string& name = access.buffer->name();
            if (!name.starts_with("positions") || name.find("residue") != std::string::npos ||
                name.find("kept") != std::string::npos)
                continue;
            const bool is_copy = name.ends_with(".1") || name.ends_with(".2");
            const int iterate = is_copy ? name.back() - '0' : 0;
            EXPECT_EQ(RegionId{iterate}, task.region) << task.body->name << " on " << name;
            seen.insert(iterate);
        }
    }
    EXPECT_EQ(seen, (std::set<int>{0, 1, 2}));
    // Per iteration some at each cut, and what the substep begins and ends with.
    EXPECT_GE(exchanges, 4 * GetParam().iterations);
}

TEST_P(OwnIteratesOf, TheRunCanBeReplayed) {
    const int half = strips_ / 2;
    const auto run = simulation(cpus(2), {{half, strips_ - half}}, 2);
    const RunDescription description = run->describe();
    SimulationOptions options;
    options.devices = "cpu/1";
    Replay replay(scene_, options, description, warnings_);
    EXPECT_EQ(replay.simulation().solver().iterate_count(), 2);
    for (int frame = 0; frame < kFrames; ++frame) {
        const FrameRecord record = run->advance();
        replay.advance(record);
        EXPECT_EQ(replay.simulation().hash(), run->hash());
    }
}

INSTANTIATE_TEST_SUITE_P(
    Solvers, OwnIteratesOf,
    testing::Values(TestCase{Method::kXpbd, &kEverything}, TestCase{Method::kXpbd, &kSolids},
                    TestCase{Method::kVbd, &kEverything}, TestCase{Method::kVbd, &kSolids},
                    TestCase{Method::kSosd, &kEverything}, TestCase{Method::kSosd, &kSolids},
                    TestCase{Method::kJpgd, &kEverything}, TestCase{Method::kJpgd, &kSolids, 4},
                    TestCase{Method::kXpbd, &kTouching}, TestCase{Method::kJpgd, &kTouching}),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(Solvers, OwnIteratesBesideOpenCl,
                         testing::Values(TestCase{Method::kXpbd, &kEverything},
                                         TestCase{Method::kJpgd, &kEverything}),
                         name_of_case);

/// The step that failed tells what went wrong, in the iterate where it did.
TEST(OwnIterates, ABadStateIsDiagnosedByTheStepThatFailed) {
    Scene scene = parse_scene(kSpringsOnly, "test.toml");
    scene.guard.max_speed = 0.3;
    Warnings warnings;
    std::vector<std::string> messages;
    for (const int iterates : {1, 2, 3}) {
        SimulationOptions options;
        options.calibrate = false;
        const int strips = Model(scene, warnings).strips.count();
        options.division = Division{{strips / 2, strips - strips / 2}};
        options.iterates = iterates;
        Simulation run(scene, cpus(2), options, warnings);
        try {
            for (int frame = 0; frame < 10; ++frame) run.advance();
            FAIL() << "nothing was too fast";
        } catch (const RunError& error) {
            messages.emplace_back(error.what());
        }
    }
    EXPECT_NE(messages[0].find("guard.max_speed"), std::string::npos) << messages[0];
    EXPECT_NE(messages[0].find("substep"), std::string::npos) << messages[0];
    // Seen at a substep's end: that is where the states are the same, the last task is another.
    const auto finding = [](const std::string& m) { return m.substr(m.find(": vertex")); };
    EXPECT_EQ(finding(messages[1]), finding(messages[0]));
    EXPECT_EQ(finding(messages[2]), finding(messages[0]));
}

}  // namespace
}  // namespace weft::test
