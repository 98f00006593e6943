// The planner on devices whose times are made up, and free of noise.

#include "simulation/planning/frame_planner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "runtime/clock.h"
#include "simulation/scene/read_scene.h"
#include "tests/simulation/planning/virtual_machine.h"

namespace weft::test {
namespace {

constexpr int kSubsteps = 8;

Scene sheet(int across, int along) {
    Scene scene = parse_scene(R"(
[scene]
frames = 1
dt = 0.016
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [2, 2] }
density = 0.2
stretch = { stiffness = 1.0e4 }
bend = { stiffness = 1.0e-4 }
)",
                              "test.toml");
    scene.cloths[0].shape = GridShape{{1.0, 1.0}, {across, along}};
    return scene;
}

/// A planner, its solver, and the machine that it plans for.
class Planned {
public:
    Planned(int across, int along, std::vector<VirtualMachine::Speed> speeds, double latency,
            PlanKind kind = PlanKind::kAuto)
        : model_(sheet(across, along), warnings_),
          solver_(make_solver(model_)),
          machine(std::move(speeds), latency),
          planner(*solver_, model_.strips.count(), machine.devices(), kind) {
        for (const FramePlan& plan : planner.calibration()) {
            planner.learn(plan, machine.run(plan, 2), 2);
        }
    }

    struct Frame {
        Division division;
        double planned, measured, plan_time;
        double next_time;  ///< what next() took, seen from outside [s]
    };
    Frame advance() {
        const double start = now();
        const FramePlan& plan = planner.next();
        const double next_time = now() - start;
        const RunTimes times = machine.run(plan, kSubsteps);
        const Frame frame{plan.division, plan.substep_time() * kSubsteps, times.end - times.start,
                          plan.plan_time, next_time};
        planner.learn(plan, times, kSubsteps);
        return frame;
    }
    Frame advance(int frames) {
        for (int i = 1; i < frames; ++i) advance();
        return advance();
    }
    int strip_count() const { return model_.strips.count(); }

    /// What the devices would take together if they could share anything.
    double ideal() const {
        double items = 0.0;
        const Step step = solver_->make_step(Partition::whole(strip_count()));
        for (const Task& task : step.tasks()) items += static_cast<double>(task.items);
        double speed = 0.0;
        for (const auto& device : machine.speeds) speed += 1.0 / device.per_item;
        return kSubsteps * items / speed;
    }

private:
    Warnings warnings_;
    Model model_;
    std::unique_ptr<Solver> solver_;

public:
    VirtualMachine machine;
    FramePlanner planner;
};

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
    const Division division = p.advance(20).division;
    for (const double factor : {1.3, 1.0 / 1.3, 0.8}) {  // slower, as before, faster
        for (VirtualMachine::Speed& speed : p.machine.speeds) {
            speed.fixed *= factor;
            speed.per_item *= factor;
        }
        p.advance();
        for (int i = 0; i < 6; ++i) {
            const auto frame = p.advance();
            EXPECT_NEAR(frame.planned / frame.measured, 1.0, 0.05) << factor << ", frame " << i;
            EXPECT_EQ(frame.division, division) << "a pace that all share changes no plan";
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

TEST(FramePlanner, ExactAndSingleKeepToTheirKind) {
    const std::vector<VirtualMachine::Speed> speeds{{2e-6, 10e-9}, {2e-6, 12e-9}};
    Planned exact(20, 60, speeds, 1e-3, PlanKind::kExact);
    EXPECT_EQ(exact.advance(5).division.devices().size(), 2U);
    Planned single(100, 200, speeds, 0.0, PlanKind::kSingle);
    EXPECT_EQ(single.advance(5).division, Division::single(2, single.strip_count(), 0));
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
