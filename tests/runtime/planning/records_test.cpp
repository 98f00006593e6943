// What is written down of a frame, and done again from it.

#include <gtest/gtest.h>

#include "runtime/error.h"
#include "runtime/planning/candidates.h"
#include "runtime/planning/frame_recorder.h"
#include "runtime/planning/recorded_plans.h"
#include "tests/runtime/planning/two_stages.h"
#include "tests/runtime/planning/virtual_machine.h"

namespace weft::test {
namespace {

constexpr int kStrips = 8;

TEST(FrameRecorder, ListsEveryTaskAndCopyByTheRunsNumbers) {
    TwoStages work(kStrips, 80, 160);
    const VirtualMachine machine({{}, {}}, 0.0);
    const TimingModel timing = known_times({{1.0, 1.0}, {1.0, 1.0}});
    Candidates candidates(work, kStrips, machine.devices(), timing);
    FramePlan plan;
    candidates.fill(Division{{3, 5}}, plan);  // tasks 0, 1 and 2, 3 are a, b of each device
    RunTimes times;
    times.tasks = {{{0, 0, 1.0, 2.0}, {0, 1, 2.0, 3.0}}, {{0, 2, 1.5, 4.0}, {0, 3, 4.5, 5.0}}};
    times.copies = {{0, 3, 0, 1, 1000, 2.5, 2.75}};

    FrameRecord frame;
    FrameRecorder(3).list(plan, times, timing, {2, 0}, frame);  // device 1 is lost
    ASSERT_EQ(frame.executions.size(), 4U);
    const std::vector<std::uint32_t> devices{2, 2, 0, 0};
    const std::vector<std::uint64_t> items{30, 60, 50, 100};
    const std::vector<double> starts{1.0, 2.0, 1.5, 4.5}, ends{2.0, 3.0, 4.0, 5.0};
    for (std::uint32_t t = 0; t < 4; ++t) {
        const ExecutionRecord& record = frame.executions[t];
        EXPECT_EQ(record.task, t);
        EXPECT_EQ(record.substep, 0U);
        EXPECT_EQ(record.device, devices[t]) << t;
        EXPECT_EQ(record.items, items[t]) << t;
        EXPECT_EQ(record.start, starts[t]) << t;
        EXPECT_EQ(record.end, ends[t]) << t;
    }
    ASSERT_EQ(frame.transfers.size(), 1U);
    EXPECT_EQ(frame.transfers[0].from, 2U);
    EXPECT_EQ(frame.transfers[0].to, 0U);
    EXPECT_EQ(frame.transfers[0].task, 3U);
    EXPECT_EQ(frame.transfers[0].bytes, 1000U);
    EXPECT_EQ(frame.plan.size(), 4U);
}

/// Whichever task it is that another version of the work would do otherwise.
TEST(RecordedPlans, RefuseAnyTaskThatIsAnotherOneHere) {
    TwoStages work(kStrips, 80, 160);
    RunDescription run;
    run.kinds = work.kinds();
    run.devices.resize(2);
    const Division division{{3, 5}};
    const FrameRecord frame = record_of(work.make_step(division.partition()), division);
    RecordedPlans plans(
        run, kStrips, [&](const Division& d) { return work.make_step(d.partition()); },
        [](const Task&) { return false; });
    EXPECT_EQ(plans.plan_of(frame, 2).plan.placements.size(), 4U);
    for (std::size_t t = 0; t < frame.plan.size(); ++t) {
        FrameRecord other = frame;
        other.plan[t].items += 1;
        EXPECT_THROW(plans.plan_of(other, 2), UserError) << t;
    }
    FrameRecord fewer = frame;
    fewer.plan.pop_back();
    EXPECT_THROW(plans.plan_of(fewer, 2), UserError);
}

/// Rows make items more, and only of tasks that have some.
TEST(RecordedPlans, TakeMoreItemsOnlyWhereTheyVary) {
    TwoStages work(kStrips, 80, 160);
    RunDescription run;
    run.kinds = work.kinds();
    run.devices.resize(2);
    const Division division{{3, 5}};
    const FrameRecord frame = record_of(work.make_step(division.partition()), division);
    RecordedPlans plans(
        run, kStrips, [&](const Division& d) { return work.make_step(d.partition()); },
        [](const Task& task) { return task.body->kind == 1; });
    for (std::size_t t = 0; t < frame.plan.size(); ++t) {
        FrameRecord more = frame, fewer = frame;
        more.plan[t].items += 1;
        fewer.plan[t].items -= 1;
        EXPECT_THROW(plans.plan_of(fewer, 2), UserError) << t;
        if (frame.plan[t].kind == 1) {
            EXPECT_EQ(plans.plan_of(more, 2).plan.placements.size(), 4U) << t;
        } else {
            EXPECT_THROW(plans.plan_of(more, 2), UserError) << t;
        }
    }
}

}  // namespace
}  // namespace weft::test
