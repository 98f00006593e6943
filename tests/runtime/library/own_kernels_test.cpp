// Kernels from outside the tree: the same bits on every device, by every plan, on devices of one's
// own, when a device is lost, and by replay.

#include <gtest/gtest.h>

#include <filesystem>
#include <numeric>

#include "tests/runtime/library/own_device.h"
#include "tests/runtime/library/own_work.h"
#include "weft/trace.h"

namespace weft::test {
namespace {

constexpr int kFrames = 6;

/// The cells' heats as plain C++ would have them.
std::vector<float> expected_heats() {
    OwnWork own;
    std::vector<own::Cell> now(own.now.span().begin(), own.now.span().end());
    std::vector<own::Cell> next = now;
    const auto spread = [&](int instance) {
        for (int c = 0; c < OwnWork::kCells; ++c) {
            const auto at = [&](int k) {
                return now[static_cast<std::size_t>(std::clamp(k, 0, OwnWork::kCells - 1))].heat;
            };
            const float loss = own.losses[static_cast<std::size_t>(
                OwnWork::kZones * instance + now[static_cast<std::size_t>(c)].zone)];
            next[static_cast<std::size_t>(c)].heat =
                at(c) + 0.2f * (at(c - 1) - 2.0f * at(c) + at(c + 1)) - loss * at(c);
        }
        std::swap(now, next);
    };
    for (int frame = 0; frame < kFrames; ++frame) {
        for (int i = 0; i < OwnWork::kInstances; ++i) {
            spread(i);
            spread(i);
        }
    }
    std::vector<float> heats;
    for (const own::Cell& cell : now) heats.push_back(cell.heat);
    return heats;
}

void expect_same(const OwnWork& own) {
    const std::vector<float> expected = expected_heats();
    for (std::size_t c = 0; c < expected.size(); ++c) {
        ASSERT_EQ(own.now[c].heat, expected[c]) << "cell " << c;
    }
}

struct Case {
    const char* devices;
    PlanKind plan = PlanKind::kAuto;
    int lanes = 0;
    bool discrete = false;
    std::optional<EntryStyle> style = {};
};

class OwnKernels : public testing::TestWithParam<Case> {};

TEST_P(OwnKernels, GiveTheBitsOfPlainCode) {
    const Case& c = GetParam();
    RunnerOptions options{.devices = c.devices, .plan = c.plan};
    options.device_options.cpu_lanes = options.device_options.opencl_lanes = c.lanes;
    if (c.discrete) options.device_options.memory = MemoryModel::kDiscrete;
    options.device_options.entry_style = c.style;
    OwnWork own;
    Runner runner(own.work, options);
    for (int frame = 0; frame < kFrames; ++frame) {
        const FrameRecord record = runner.advance(OwnWork::kInstances);
        EXPECT_GT(record.measured_makespan, 0.0);
        EXPECT_GT(record.planned_makespan, 0.0);
    }
    expect_same(own);
}

INSTANTIATE_TEST_SUITE_P(
    Devices, OwnKernels,
    testing::Values(
        Case{"cpu/1"}, Case{"cpu/2"}, Case{.devices = "cpu/1", .lanes = 1}, Case{"opencl:0/1"},
        Case{.devices = "opencl:0/1", .lanes = 1},
        Case{.devices = "opencl:0/1", .style = EntryStyle::kPerColour},
        Case{.devices = "opencl:0/1", .style = EntryStyle::kPerGroup},
        Case{"cpu/1+opencl:0/1", PlanKind::kExact}, Case{"cpu/1+opencl:0/1", PlanKind::kPlaced},
        Case{.devices = "cpu/1+opencl:0/1", .plan = PlanKind::kExact, .discrete = true}));

TEST(OwnDevices, RunBesideOthersWithTheSameBits) {
    OwnWork own;
    std::vector<std::unique_ptr<Device>> devices = open_devices("cpu/1");
    devices.push_back(std::make_unique<OwnDevice>());
    Runner runner(own.work, std::move(devices), {.plan = PlanKind::kExact});
    for (int frame = 0; frame < kFrames; ++frame) runner.advance(OwnWork::kInstances);
    EXPECT_TRUE(runner.lost_devices().empty());
    expect_same(own);
}

TEST(OwnDevices, MayBeLost) {
    for (const int tasks_until_loss : {3, 80}) {  // while it is profiled, and in a frame
        OwnWork own;
        std::vector<std::unique_ptr<Device>> devices = open_devices("cpu/1");
        devices.push_back(std::make_unique<OwnDevice>(tasks_until_loss));
        Runner runner(own.work, std::move(devices), {.plan = PlanKind::kExact});
        EXPECT_EQ(runner.lost_devices().size(), tasks_until_loss == 3 ? 1U : 0U);
        for (int frame = 0; frame < kFrames; ++frame) runner.advance(OwnWork::kInstances);
        EXPECT_EQ(runner.lost_devices(), std::vector{1});
        ASSERT_FALSE(runner.warnings().empty());
        EXPECT_NE(runner.warnings().back().find("was lost"), std::string::npos);
        expect_same(own);
    }
}

/// A launch alone takes its turns with nobody.
TEST(OwnKernels, LaunchesThatTakeTurnsDoAllColours) {
    OwnWork own, other;
    Buffer<int> begin("colours", 3);
    begin[1] = OwnWork::kCells / 2;
    begin[2] = OwnWork::kCells;
    own.strips = other.strips = {&begin, 0, 2, 1};
    const TaskBody turns{"turns", 0, {own.spread(own.now, own.next)}, 1};
    const TaskBody plain{"plain", 0, {other.spread(other.now, other.next)}};
    run_on_host(turns, 0);
    run_on_host(plain, 0);
    for (std::size_t c = 0; c < OwnWork::kCells; ++c) {
        ASSERT_EQ(own.next[c].heat, other.next[c].heat) << c;
        ASSERT_EQ(own.next[c].flux, other.next[c].flux) << c;
    }
    EXPECT_NE(own.next[1].heat, 0.0f);
}

TEST(OwnKernels, ALaunchPassesOverStripsThatItsGateSays) {
    OwnWork own, all;
    Buffer<int> gate("gate", OwnWork::kStrips);
    gate[1] = 1;
    const TaskBody gated{"gated", 0, {only_where(gate, own.spread(own.now, own.next))}};
    const TaskBody plain{"plain", 0, {all.spread(all.now, all.next)}};
    for (int strip = 0; strip < OwnWork::kStrips; ++strip) {
        run_on_host(gated, strip);
        run_on_host(plain, strip);
    }
    for (int c = 0; c < OwnWork::kCells; ++c) {
        const bool is_open = own.strips.item(1) <= c && c < own.strips.item(2);
        const auto cell = static_cast<std::size_t>(c);
        ASSERT_EQ(own.next[cell].heat, is_open ? all.next[cell].heat : 0.0f) << c;
    }
}

TEST(OwnWork, PartsOfAFrameAreAllOfItsTime) {
    OwnWork own;
    Runner runner(own.work, {.devices = "cpu/1"});
    double last_end = 0.0;
    for (std::uint32_t number = 0; number < 3; ++number) {
        const FrameRecord frame = runner.advance(OwnWork::kInstances);
        EXPECT_EQ(frame.frame, number);
        const std::vector<double> parts{frame.place_time, frame.plan_time, frame.execute_time,
                                        frame.learn_time};
        for (const double part : parts) EXPECT_GE(part, 0.0);
        EXPECT_NEAR(std::accumulate(parts.begin(), parts.end(), 0.0), frame.end - frame.start,
                    1e-9);
        EXPECT_GE(frame.start, last_end);
        last_end = frame.end;
    }
}

TEST(OwnSteps, ArePlacedTaskByTask) {
    OwnWork own;
    const TaskBody there{"there", 0, {own.spread(own.now, own.next)}};
    const TaskBody back{"back", 1, {own.spread(own.next, own.now)}};
    Step step;
    constexpr int kTasks = 4, kEach = OwnWork::kStrips / kTasks;
    for (const TaskBody* body : {&there, &back}) {
        Buffer<own::Cell>& from = body == &there ? own.now : own.next;
        Buffer<own::Cell>& to = body == &there ? own.next : own.now;
        for (int t = 0; t < kTasks; ++t) {
            const int first = t * kEach, end = first + kEach;
            step.add(*body, 0, {first, end})
                .reads(from, own.strips, std::max(first - 1, 0), std::min(end + 1, own.kStrips))
                .reads_by_instance(own.losses, OwnWork::kZones)
                .updates(to, own.strips);
        }
    }
    step.seal();
    StepWork work(step);
    for (const PlanKind kind : {PlanKind::kAuto, PlanKind::kPlaced, PlanKind::kExact}) {
        OwnWork fresh;
        std::ranges::copy(fresh.now.span(), own.now.span().begin());
        Runner runner(work, {.devices = "cpu/1+opencl:0/1", .plan = kind});
        for (int frame = 0; frame < kFrames; ++frame) runner.advance(OwnWork::kInstances);
        expect_same(own);
    }
}

TEST(OwnTraces, AreReplayedWithTheSameState) {
    const auto path = std::filesystem::temp_directory_path() / "weft_own_trace.h5";
    {
        OwnWork own;
        Runner runner(own.work, {.devices = "cpu/1+opencl:0/1", .trace = path});
        for (int frame = 0; frame < kFrames; ++frame) runner.advance(OwnWork::kInstances);
        runner.finish();
    }
    const TraceReader trace(path);
    EXPECT_TRUE(trace.finished());
    ASSERT_EQ(trace.frames().size(), std::size_t{kFrames});
    OwnWork own;
    Runner runner(own.work, {.devices = "cpu/2", .calibrate = 0});
    for (std::size_t f = 0; f < trace.frames().size(); ++f) {
        EXPECT_FALSE(trace.frame(f).executions.empty());
        EXPECT_EQ(runner.frame(), static_cast<int>(f));
        runner.replay(trace.run(), trace.frame(f));
    }
    EXPECT_EQ(runner.frame(), kFrames);
    EXPECT_EQ(runner.state_hash(), trace.state_hash());
    expect_same(own);
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace weft::test
