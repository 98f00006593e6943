#include "runtime/planning/timing_model.h"

#include <gtest/gtest.h>

#include "runtime/planning/frame_recorder.h"

namespace weft::test {
namespace {

/// Copies alone, of no step at all.
void learn(TimingModel& model, const std::vector<CopyRecord>& copies) {
    Step nothing;
    nothing.seal();
    RunTimes times;
    times.copies = copies;
    model.learn(nothing, {}, times, 0);
}

TEST(TimingModel, BandwidthsAreThoseOfAllLongCopiesTogether) {
    TimingModel model(1, 2);
    const CopyRecord one{0, 0, 0, 1, 100000, 1.0, 2.0};
    const CopyRecord slow{0, 0, 0, 1, 100000, 2.0, 5.0};
    const CopyRecord short_one{0, 0, 0, 1, 100, 5.0, 9.0};
    const CopyRecord back{0, 0, 1, 0, 50000, 0.0, 1.0};
    learn(model, {one, slow, short_one, back});
    EXPECT_NEAR(model.link(0, 1).bandwidth, 200000.0 / 4.0, 1e-6);
    EXPECT_NEAR(model.link(1, 0).bandwidth, 50000.0, 1e-6);
    // What is new counts for three tenths.
    learn(model, {one});
    EXPECT_NEAR(1.0 / model.link(0, 1).bandwidth, 0.7 / 50000.0 + 0.3 / 100000.0, 1e-12);
    EXPECT_NEAR(model.link(1, 0).bandwidth, 50000.0, 1e-6);
}

/// a, on device 0, reads what b, on device 1, made in the instance before.
struct FromOneInstanceToTheNext {
    FromOneInstanceToTheNext() {
        step.add(a, 0, {0, 0}).reads(buffer, 0, 10);
        step.add(b, 0, {0, 0}).updates(buffer, 0, 10);
        step.seal();
        plan.placements = {{0.0, 1.0, 0}, {1.0, 2.0, 1}};
    }

    /// Both wait: b by 0.1, a by 0.3 ms.
    std::vector<double> wait() {
        RunTimes times;
        times.tasks = {{{0, 0, 0.0, 1.0e-3}, {1, 0, 2.4e-3, 3.4e-3}},
                       {{0, 1, 1.1e-3, 2.1e-3}, {1, 1, 3.5e-3, 4.5e-3}}};
        times.end = 4.5e-3;
        return model.learn(step, plan, times, 2);
    }

    /// Of 20 times a waits once, by 1 ms; else it is busy until 0.2 ms after its data came.
    void wait_once() {
        constexpr int kInstances = 21, kLate = 10;
        RunTimes times;
        times.tasks.resize(2);
        double free = 0.0;
        for (int i = 0; i < kInstances; ++i) {
            const double start = i == kLate ? free + 1.1e-3 : free;
            const double data = i + 1 == kLate ? start + 1.1e-3 : start + 0.8e-3;
            times.tasks[0].push_back({i, 0, start, start + 1.0e-3});
            times.tasks[1].push_back({i, 1, data - 0.1e-3, data});
            free = start + 1.0e-3;
        }
        times.end = free;
        model.learn(step, plan, times, kInstances);
    }

    Buffer<float> buffer{"buffer", 10};
    TaskBody a{"a", 0, {}}, b{"b", 0, {}};
    Step step;
    scheduler::Plan plan;
    TimingModel model{1, 2};
};

TEST(TimingModel, LatenciesAreLearntFromOneInstanceToTheNext) {
    FromOneInstanceToTheNext run;
    const std::vector<double> mean = run.wait();
    EXPECT_NEAR(run.model.latency(0, 1), 1.0e-4, 1e-9);
    EXPECT_NEAR(run.model.latency(1, 0), 3.0e-4, 1e-9);
    ASSERT_EQ(mean.size(), 2U);
    for (const double cost : mean) EXPECT_NEAR(cost, 1.0e-3, 1e-9) << "without waiting";
}

/// What waits where hardly anything does is the longest of all.
TEST(TimingModel, AFewWaitsSayLittleOfALatency) {
    FromOneInstanceToTheNext run;
    run.wait();
    run.wait_once();
    EXPECT_NEAR(run.model.latency(1, 0), 3.0e-4 + 0.06 * 7.0e-4, 1e-9);
}

TEST(FrameRecorder, SumsUpWhatEachDeviceDid) {
    FramePlan plan;
    plan.plan.makespan = 2.0;
    plan.slowdown = 1.5;
    RunTimes times;
    times.start = 1.0;
    times.end = 9.0;
    times.tasks = {{{0, 0, 1.0, 2.0}, {1, 0, 2.5, 4.0}}, {{0, 1, 1.0, 1.25}}};
    times.copies = {{0, 0, 0, 1, 1000, 1.0, 2.0}, {0, 0, 1, 0, 24, 1.0, 2.0}};
    FrameRecord frame;
    FrameRecorder(3).sum_up(plan, times, 4, {2, 0}, frame);  // device 1 is lost
    EXPECT_EQ(frame.busy, (std::vector{0.25, 0.0, 2.5}));
    EXPECT_EQ(frame.transferred_bytes, 1024U);
    EXPECT_EQ(frame.planned_makespan, 12.0);
    EXPECT_EQ(frame.measured_makespan, 8.0);
    EXPECT_EQ(frame.pace, 1.5);
}

}  // namespace
}  // namespace weft::test
