// A device that fails in mid-run: the others do its work, and the result is the same.

#include <gtest/gtest.h>

#include "runtime/error.h"
#include "runtime/tbb/cpu_device.h"
#include "simulation/replay.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "tests/simulation/run/failing_device.h"
#include "tests/simulation/run/test_scenes.h"

namespace weft::test {
namespace {

constexpr int kNever = 1'000'000;
constexpr int kFrames = 6;

/// One CPU device per number: how many batches of work it survives.
std::vector<std::unique_ptr<Device>> devices(const std::vector<int>& batches) {
    std::vector<std::unique_ptr<Device>> list;
    for (const int count : batches) {
        list.push_back(make_failing_device(make_cpu_device(1, {}), {count}));
    }
    return list;
}

/// Two of them, of which the second one fails.
std::vector<std::unique_ptr<Device>> second_of_two(Failure failure) {
    std::vector<std::unique_ptr<Device>> list;
    list.push_back(make_cpu_device(1, {}));
    list.push_back(make_failing_device(make_cpu_device(1, {}), failure));
    return list;
}

class DeviceLoss : public testing::TestWithParam<int> {
protected:
    Simulation simulation(const std::vector<int>& batches, PlanKind plan = PlanKind::kExact) {
        SimulationOptions options;
        options.plan = plan;
        return {parse_scene(kEverything, "everything.toml"), devices(batches), options, warnings_};
    }

private:
    Warnings warnings_;
};

std::string hash_after(Simulation& simulation, int frames) {
    for (int i = 0; i < frames; ++i) simulation.advance();
    return simulation.hash();
}

/// Calibration takes 2 rounds of 3 plans (each device, both), each with all devices.
constexpr int kCalibration = 6;

TEST_P(DeviceLoss, TheOthersGoOnWithTheSameResult) {
    Simulation undisturbed = simulation({kNever, kNever});
    const std::string expected = hash_after(undisturbed, kFrames);

    const int lost = GetParam();
    std::vector<int> batches{kNever, kNever};
    batches[static_cast<std::size_t>(lost)] = kCalibration + 2;
    Simulation disturbed = simulation(batches);
    EXPECT_EQ(hash_after(disturbed, kFrames), expected);
    ASSERT_EQ(disturbed.losses().size(), 1U);
    EXPECT_EQ(disturbed.losses()[0].device, lost);
    EXPECT_EQ(disturbed.losses()[0].frame, 2);
    EXPECT_NE(disturbed.losses()[0].why.find("CL_OUT_OF_RESOURCES"), std::string::npos);
}

TEST_P(DeviceLoss, ItsWorkIsRecordedUnderTheOthersNumbers) {
    const int lost = GetParam();
    std::vector<int> batches{kNever, kNever};
    batches[static_cast<std::size_t>(lost)] = kCalibration + 2;
    Simulation disturbed = simulation(batches);
    hash_after(disturbed, kFrames - 1);
    const FrameRecord frame = disturbed.advance();
    ASSERT_EQ(frame.busy.size(), 2U);
    EXPECT_EQ(frame.busy[static_cast<std::size_t>(lost)], 0.0);
    EXPECT_GT(frame.busy[static_cast<std::size_t>(1 - lost)], 0.0);
    ASSERT_FALSE(frame.executions.empty());
    for (const auto& e : frame.executions) EXPECT_EQ(static_cast<int>(e.device), 1 - lost);
    for (const auto& p : frame.plan) EXPECT_EQ(static_cast<int>(p.device), 1 - lost);
}

/// The plans before and after the loss, each on the devices that it had.
TEST_P(DeviceLoss, TheRunCanBeReplayed) {
    const int lost = GetParam();
    std::vector<int> batches{kNever, kNever};
    batches[static_cast<std::size_t>(lost)] = kCalibration + 2;
    Simulation disturbed = simulation(batches);
    const RunDescription run = disturbed.describe();
    SimulationOptions options;
    options.devices = "cpu/1";  // a machine with less: what was device i's goes to i modulo 1
    Warnings warnings;
    Replay replay(parse_scene(kEverything, "everything.toml"), options, run, warnings);
    for (int i = 0; i < kFrames; ++i) {
        replay.advance(disturbed.advance());
        EXPECT_EQ(replay.simulation().hash(), disturbed.hash()) << "after frame " << i;
    }
    EXPECT_EQ(disturbed.losses().size(), 1U);
}

/// A solver may carry state of its own from substep to substep.
TEST_F(DeviceLoss, WithASolverThatHasAMemory) {
    Scene scene = parse_scene(kEverything, "everything.toml");
    scene.solver.method = Method::kVbd;
    SimulationOptions options;
    options.plan = PlanKind::kExact;
    Warnings warnings;
    Simulation undisturbed(scene, devices({kNever, kNever}), options, warnings);
    Simulation disturbed(scene, devices({kNever, kCalibration + 2}), options, warnings);
    EXPECT_EQ(hash_after(disturbed, kFrames), hash_after(undisturbed, kFrames));
    EXPECT_EQ(disturbed.losses().size(), 1U);
}

/// What contact knows from substep to substep is of the frame's middle then.
TEST_F(DeviceLoss, InTheMiddleOfAFrameWithContact) {
    const Scene scene = parse_scene(kRubbing, "rubbing.toml");
    SimulationOptions options;
    options.plan = PlanKind::kExact;
    Warnings warnings;
    Simulation undisturbed(scene, devices({kNever, kNever}), options, warnings);
    const std::string expected = hash_after(undisturbed, kFrames);
    for (int tasks = 0; tasks < 60; tasks += 4) {
        Simulation disturbed(scene, second_of_two({kCalibration + 2, tasks}), options, warnings);
        EXPECT_EQ(hash_after(disturbed, kFrames), expected) << "lost behind " << tasks << " tasks";
        ASSERT_EQ(disturbed.losses().size(), 1U);
        EXPECT_NE(disturbed.losses()[0].why.find("clEnqueueNDRangeKernel"), std::string::npos);
    }
}

INSTANTIATE_TEST_SUITE_P(Each, DeviceLoss, testing::Values(0, 1));

TEST_F(DeviceLoss, TwoOfThreeOneAfterTheOther) {
    Simulation undisturbed = simulation({kNever});
    const std::string expected = hash_after(undisturbed, kFrames);
    // Three devices calibrate by four plans.
    Simulation disturbed = simulation({8 + 1, kNever, 8 + 3});
    EXPECT_EQ(hash_after(disturbed, kFrames), expected);
    ASSERT_EQ(disturbed.losses().size(), 2U);
    EXPECT_EQ(disturbed.losses()[0].device, 0);
    EXPECT_EQ(disturbed.losses()[1].device, 2);
}

TEST_F(DeviceLoss, WithNoneLeftTheRunFails) {
    Simulation disturbed = simulation({kCalibration, kCalibration});
    try {
        hash_after(disturbed, 1);
        FAIL() << "it went on";
    } catch (const RunError& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find("frame 0"), std::string::npos) << what;
        EXPECT_NE(what.find("no other"), std::string::npos) << what;
    }
}

}  // namespace
}  // namespace weft::test
