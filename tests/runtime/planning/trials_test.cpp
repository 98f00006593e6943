// Devices that sleep, costs of another hour, and teams that take turns: the machine's times are
// made up, and free of noise.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/runtime/planning/planned.h"

namespace weft::test {
namespace {

constexpr double kLatency = 20e-6;
constexpr int kAcross = 60, kAlong = 100;

double best_of_all(const std::vector<VirtualMachine::Speed>& speeds) {
    Planned exact(kAcross, kAlong, speeds, kLatency, PlanKind::kExact);
    Planned single(kAcross, kAlong, speeds, kLatency, PlanKind::kSingle);
    return std::min(exact.advance(20).measured, single.advance(20).measured);
}

/// The first frame after a sleep takes several times as long, whatever its plan.
TEST(PlannerTrials, ADeviceThatSleepsIsJudgedAwake) {
    for (const double waking : {2.0, 5.0, 20.0}) {
        const std::vector<VirtualMachine::Speed> speeds{{2e-6, 20e-9}, {2e-6, 20e-9, {}, waking}};
        Planned p(kAcross, kAlong, speeds, kLatency);
        const auto frame = p.advance(30);
        EXPECT_EQ(frame.division.devices().size(), 2U) << waking;
        EXPECT_LT(frame.measured, 1.05 * best_of_all(speeds)) << waking;
    }
}

/// Something was wrong with the mixture for some frames, and the device fell asleep since.
TEST(PlannerTrials, ADeviceThatFellAsleepIsFoundAgain) {
    const std::vector<VirtualMachine::Speed> speeds{{2e-6, 20e-9}, {2e-6, 20e-9, {}, 6.0}};
    Planned p(kAcross, kAlong, speeds, kLatency);
    const double before = p.advance(10).measured;
    p.machine.latency = 20.0 * kLatency;
    ASSERT_EQ(p.advance(20).division.devices().size(), 1U);
    p.machine.latency = kLatency;
    EXPECT_LT(p.advance(120).measured, 1.02 * before);
}

/// All that is remembered says that the second device is slow and far away.
TEST(PlannerTrials, RememberedCostsAreNoVerdict) {
    const std::vector<VirtualMachine::Speed> speeds{{2e-6, 20e-9}, {2e-6, 20e-9}};
    for (const double factor : {1.8, 5.0, 40.0}) {
        Planned p(
            kAcross, kAlong, speeds, kLatency, PlanKind::kAuto, {}, std::nullopt,
            [&](Planned& planned) {
                TimingModel& timing = planned.planner.timing();
                for (std::uint32_t kind = 0; kind < timing.costs().kinds(); ++kind) {
                    timing.costs().restore(kind, 0, {{2e-6, 20e-9}, 0.1, 50});
                    timing.costs().restore(kind, 1, {{2e-6 * factor, 20e-9 * factor}, 0.1, 50});
                }
                timing.set_latency(0, 1, 3e-3);
                timing.set_latency(1, 0, 3e-3);
            });
        EXPECT_LT(p.advance(10).measured, 1.05 * best_of_all(speeds)) << factor;
    }
}

/// What is forecast to be fast, and has never been seen, takes longer than ten frames: one frame
/// begins by it, and nothing is ever chosen by that forecast again.
TEST(PlannerTrials, AMistakeIsGivenUpInTheMiddleOfAFrame) {
    Planned p(kAcross, kAlong, {{2e-6, 20e-9}, {2e-6, 25e-9}}, 20e-3);
    p.advance(10);
    const auto before = p.advance();
    ASSERT_EQ(before.division.devices(), std::vector{0});
    for (const auto& [from, to] : {std::pair(0, 1), std::pair(1, 0)}) {
        p.planner.timing().set_latency(from, to, 1e-6);
    }
    for (int i = 0; i < 40; ++i) {
        const auto frame = p.advance();
        EXPECT_EQ(frame.division.devices(), std::vector{0}) << i;
        EXPECT_NEAR(frame.measured / before.measured, 1.0, 1e-9) << i;
    }
    EXPECT_EQ(p.given_up(), 1);
}

/// The mixture, left a moment ago, is forecast to be the fastest again, too early for a trial, and
/// takes twice as long: two frames are lost by that, of which the first one only wakes a device.
TEST(PlannerTrials, ASmallerMistakeIsTakenBackOnceItIsSeen) {
    Planned p(kAcross, kAlong, {{2e-6, 20e-9}, {2e-6, 25e-9}}, 20e-6);
    ASSERT_EQ(p.advance(10).division.devices().size(), 2U);
    p.machine.latency = 800e-6;
    int frames = 0;
    while (p.advance().division.devices().size() == 2 && frames < 20) ++frames;
    const auto before = p.advance();
    ASSERT_EQ(before.division.devices(), std::vector{0});
    for (const auto& [from, to] : {std::pair(0, 1), std::pair(1, 0)}) {
        p.planner.timing().set_latency(from, to, 1e-6);
    }
    int mixed = 0;
    for (int i = 0; i < 10; ++i) {
        const auto frame = p.advance();
        if (frame.division.devices().size() == 1) continue;
        EXPECT_GT(frame.measured, 1.5 * before.measured);
        ++mixed;
    }
    EXPECT_EQ(mixed, 2);
    EXPECT_EQ(p.given_up(), 0);
}

/// All devices become slow together right after the start. The third one, which calibration has
/// seen drowsy only, is the fastest: a trial that had to beat the mixture's forecast would be lost.
TEST(PlannerTrials, HaveToBeatWhatWasMeasured) {
    const std::vector<VirtualMachine::Speed> speeds{
        {2e-6, 20e-9}, {2e-6, 20e-9}, {2e-6, 9e-9, {}, 1.5}};
    Planned p(kAcross, kAlong, speeds, kLatency, PlanKind::kAuto, {0, 0, 1});
    for (VirtualMachine::Speed& speed : p.machine.speeds) {
        speed.fixed *= 4.0;
        speed.per_item *= 4.0;
    }
    p.machine.latency *= 4.0;
    EXPECT_EQ(p.advance(8).division.devices(), std::vector{2});
}

/// A third device has the cores of the other two, whose exchange takes longer than calibration saw.
/// Neither at the start nor later is it left for a mere forecast: trials are all that others get.
TEST(PlannerTrials, AllCoresByOneAreLeftForWhatWasSeenOnly) {
    const std::vector<VirtualMachine::Speed> speeds{{2e-6, 20e-9}, {2e-6, 20e-9}, {2e-6, 11e-9}};
    Planned p(kAcross, kAlong, speeds, kLatency, PlanKind::kAuto, {0, 0, 1});
    p.machine.latency *= 10.0;
    constexpr int kTrial = 4, kStart = 30, kFrames = 210;
    int others = 0;
    double sum = 0.0, least = 1.0;
    for (int i = 0; i < kFrames; ++i) {
        const auto frame = p.advance();
        if (i < kStart && frame.division.devices() != std::vector{2}) ++others;
        sum += frame.measured;
        least = std::min(least, frame.measured);
    }
    EXPECT_LE(others, kTrial);
    EXPECT_LT(sum, 1.015 * kFrames * least) << "a per cent for trials, and a frame in advance";
}

/// The third device is the fastest, but slow for as long as it takes the others to win a trial.
TEST(PlannerTrials, AllCoresByOneHaveAReturnMatch) {
    const std::vector<VirtualMachine::Speed> speeds{{2e-6, 20e-9}, {2e-6, 20e-9}, {2e-6, 8e-9}};
    Planned p(kAcross, kAlong, speeds, kLatency, PlanKind::kAuto, {0, 0, 1});
    p.machine.speeds[2].per_item *= 2.0;
    ASSERT_EQ(p.advance().division.devices(), std::vector{2});
    for (int i = 0; i < 10 && p.advance().division.devices() == std::vector{2}; ++i) continue;
    p.machine.speeds[2].per_item /= 2.0;
    EXPECT_EQ(p.advance(20).division.devices(), std::vector{2});
}

/// A third device that has the cores of the other two.
TEST(PlannerTrials, TeamsTakeTurnsAndTheFasterOneWorks) {
    for (const double alone : {7e-9, 10e-9, 14e-9}) {
        const std::vector<VirtualMachine::Speed> speeds{
            {2e-6, 20e-9}, {2e-6, 20e-9}, {2e-6, alone}};
        Planned p(kAcross, kAlong, speeds, kLatency, PlanKind::kAuto, {0, 0, 1});
        const Planned whole(kAcross, kAlong, {{2e-6, alone}}, kLatency);
        double sum = 0.0;
        constexpr int kFrames = 100;
        for (int i = 0; i < kFrames; ++i) {
            const auto frame = p.advance();
            const auto devices = frame.division.devices();
            EXPECT_TRUE(devices == std::vector{2} || std::ranges::count(devices, 2) == 0);
            if (i >= 20) sum += frame.measured / (kFrames - 20);
        }
        EXPECT_LT(sum, 1.03 * whole.ideal() + kSubsteps * 18 * 2e-6) << alone;
        EXPECT_LT(sum, 1.03 * best_of_all({speeds[0], speeds[1]})) << alone;
    }
}

}  // namespace
}  // namespace weft::test
