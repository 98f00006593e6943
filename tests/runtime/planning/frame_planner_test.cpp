// The planner on devices whose times are made up, and free of noise.

#include "runtime/planning/frame_planner.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/runtime/planning/planned.h"

namespace weft::test {
namespace {

TEST(FramePlanner, FindsTheBalanceOfTwoDevicesWithinAFewFrames) {
    for (const double ratio : {1.0, 2.0, 3.0, 7.0}) {
        Planned p(100, 200, {{2e-6, 10e-9}, {2e-6, 10e-9 * ratio}}, 20e-6);
        const auto frame = p.advance(6);
        EXPECT_LT(frame.measured, 1.1 * p.ideal()) << "ratio " << ratio;
        EXPECT_NEAR(frame.division.strips[0], p.strip_count() * ratio / (1.0 + ratio), 2.0);
    }
}

TEST(FramePlanner, FindsTheBalanceOfThreeDevices) {
    Planned p(100, 200, {{2e-6, 10e-9}, {2e-6, 20e-9}, {2e-6, 20e-9}}, 20e-6);
    const auto frame = p.advance(10);
    EXPECT_LT(frame.measured, 1.15 * p.ideal());
    for (const int strips : frame.division.strips) EXPECT_GT(strips, 0);
}

TEST(FramePlanner, PlannedIsMeasuredWhereTimesAreFreeOfNoise) {
    for (const PlanKind kind : {PlanKind::kAuto, PlanKind::kExact, PlanKind::kSingle}) {
        Planned p(60, 100, {{3e-6, 12e-9}, {8e-6, 17e-9}}, 40e-6, kind);
        p.advance(10);
        for (int i = 0; i < 10; ++i) {
            const auto frame = p.advance();
            EXPECT_NEAR(frame.planned / frame.measured, 1.0, 0.01);
        }
    }
}

TEST(FramePlanner, KnowsTheMachinesPaceAfterOneFrame) {
    Planned p(60, 100, {{3e-6, 12e-9}, {8e-6, 17e-9}}, 40e-6);
    const Division division = p.advance(21).division;
    for (const double factor : {1.3, 1.0 / 1.3, 0.8}) {  // slower, as before, faster
        for (VirtualMachine::Speed& speed : p.machine.speeds) {
            speed.fixed *= factor;
            speed.per_item *= factor;
        }
        p.advance();
        for (int i = 0; i < 6; ++i) {
            const auto frame = p.advance();
            EXPECT_NEAR(frame.planned / frame.measured, 1.0, 0.05) << factor << ", frame " << i;
            EXPECT_EQ(frame.division.strips, division.strips)
                << "a pace that all share changes no plan";
        }
    }
}

TEST(FramePlanner, SmallGraphsStayOnTheFastestDevice) {
    Planned p(20, 20, {{5e-6, 20e-9}, {2e-6, 10e-9}}, 300e-6);
    for (int i = 0; i < 10; ++i) {
        EXPECT_EQ(p.advance().division, Division::single(2, p.strip_count(), 1));
    }
}

TEST(FramePlanner, IsNeverMuchSlowerThanTheBestSingleDevice) {
    for (const double latency : {0.0, 20e-6, 100e-6, 1e-3}) {
        for (const int size : {10, 30, 80}) {
            const std::vector<VirtualMachine::Speed> speeds{{5e-6, 20e-9}, {2e-6, 30e-9}};
            Planned any(size, size, speeds, latency);
            Planned single(size, size, speeds, latency, PlanKind::kSingle);
            EXPECT_LT(any.advance(10).measured, 1.02 * single.advance(10).measured)
                << size << " x " << size << ", latency " << latency;
        }
    }
}

TEST(FramePlanner, FollowsADeviceThatBecomesSlowAndRecovers) {
    Planned p(100, 200, {{2e-6, 10e-9}, {2e-6, 10e-9}}, 20e-6);
    const double before = p.advance(10).measured;
    p.machine.speeds[1].per_item *= 4.0;
    EXPECT_LT(p.advance(40).measured, 1.15 * p.ideal());
    p.machine.speeds[1].per_item /= 4.0;
    EXPECT_LT(p.advance(60).measured, 1.05 * before);
}

TEST(FramePlanner, OneDisturbedFrameChangesLittle) {
    Planned p(100, 200, {{2e-6, 10e-9}, {2e-6, 10e-9}}, 20e-6);
    const auto before = p.advance(15);
    p.machine.speeds[1].per_item *= 10.0;
    p.advance();
    p.machine.speeds[1].per_item /= 10.0;
    const auto after = p.advance();
    EXPECT_LT(after.measured, 1.1 * before.measured);
    EXPECT_NEAR(after.planned / before.planned, 1.0, 0.1);
}

/// The exchange is slow for some frames, so that one device alone is faster.
TEST(FramePlanner, ReturnsToAMixtureThatLookedSlow) {
    constexpr double kUsual = 20e-6;
    for (const double factor : {20.0, 30.0, 60.0}) {
        Planned p(60, 100, {{2e-6, 20e-9}, {2e-6, 20e-9}}, kUsual);
        const auto before = p.advance(10);
        ASSERT_EQ(before.division.devices().size(), 2U);
        p.machine.latency = factor * kUsual;
        ASSERT_EQ(p.advance(20).division.devices().size(), 1U) << factor;
        p.machine.latency = kUsual;
        const auto after = p.advance(250);  // the dearest trial takes its time to be earned
        EXPECT_EQ(after.division.devices().size(), 2U) << factor;
        EXPECT_LT(after.measured, 1.02 * before.measured) << factor;
    }
}

TEST(FramePlanner, DoesNotTrustLatenciesOfAnotherDayForLong) {
    Planned p(60, 100, {{2e-6, 20e-9}, {2e-6, 20e-9}}, 20e-6);
    p.planner.timing().set_latency(0, 1, 400e-6);
    p.planner.timing().set_latency(1, 0, 400e-6);
    EXPECT_EQ(p.advance().division.devices().size(), 1U);
    EXPECT_EQ(p.advance(6).division.devices().size(), 2U);
}

/// Frames of one substep earn trials as any others do.
TEST(FramePlanner, DoesNotTrustThemInFramesOfOneSubstepEither) {
    Planned p(60, 100, {{2e-6, 20e-9}, {2e-6, 20e-9}}, 20e-6);
    p.planner.timing().set_latency(0, 1, 400e-6);
    p.planner.timing().set_latency(1, 0, 400e-6);
    Division division;
    for (int i = 0; i < 20; ++i) {
        const FramePlan& plan = p.planner.next();
        division = plan.division();
        if (i == 0) {
            ASSERT_EQ(division.devices().size(), 1U);
        }
        p.planner.learn(plan, p.machine.run(plan, 1), 1);
    }
    EXPECT_EQ(division.devices().size(), 2U);
}

/// Another device has become faster, and has to be given the state first.
TEST(FramePlanner, MovesOnlyWhereMovingTakesLessThanItGains) {
    for (const double bandwidth : {1e3, 1e15}) {
        Planned p(60, 100, {{2e-6, 20e-9}, {2e-6, 30e-9}}, 20e-6, PlanKind::kSingle);
        p.planner.timing().set_link(0, 1, {20e-6, bandwidth});
        p.planner.timing().set_link(1, 0, {20e-6, bandwidth});
        ASSERT_EQ(p.advance().division, Division::single(2, p.strip_count(), 0));
        p.machine.speeds[0].per_item *= 3.0;
        const bool pays = bandwidth > 1e6;
        EXPECT_EQ(p.advance(40).division, Division::single(2, p.strip_count(), pays ? 1 : 0))
            << bandwidth << " bytes/s";
    }
}

TEST(FramePlanner, ExactAndSingleKeepToTheirKind) {
    const std::vector<VirtualMachine::Speed> speeds{{2e-6, 10e-9}, {2e-6, 12e-9}};
    Planned exact(20, 60, speeds, 1e-3, PlanKind::kExact);
    EXPECT_EQ(exact.advance(5).division.devices().size(), 2U);
    Planned single(100, 200, speeds, 0.0, PlanKind::kSingle);
    EXPECT_EQ(single.advance(8).division, Division::single(2, single.strip_count(), 0));
}

/// As a clock around it sees: never more than that, and but for an interruption not much less.
TEST(FramePlanner, ReportsItsOwnTime) {
    Planned p(100, 200, {{2e-6, 10e-9}, {2e-6, 15e-9}}, 20e-6);
    p.advance(20);
    double sum = 0.0;
    double largest_share = 0.0;
    for (int i = 0; i < 50; ++i) {
        const auto frame = p.advance();
        EXPECT_GT(frame.plan_time, 0.0);
        EXPECT_LE(frame.plan_time, frame.next_time);
        largest_share = std::max(largest_share, frame.plan_time / frame.next_time);
        sum += frame.plan_time;
    }
    EXPECT_GT(largest_share, 0.8) << "what is not counted";
    RecordProperty("steady_plan_time_us", std::to_string(sum / 50 * 1e6));
}

}  // namespace
}  // namespace weft::test
