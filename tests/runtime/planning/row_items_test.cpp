#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "runtime/planning/row_items.h"
#include "runtime/planning/timing_model.h"
#include "tests/runtime/planning/virtual_machine.h"

namespace weft::test {
namespace {

constexpr int kStrips = 4;
constexpr int kItems = 40;

/// Two kinds of tasks over the same strips, of which one walks rows.
class WorkWithRows final : public StepMaker {
public:
    WorkWithRows() {
        for (TaskBody* body : {&walking_, &plain_}) body->launches[0].segments = strips_;
        Argument rows;
        rows.buffer = &table_.rows();
        walking_.launches[0].arguments.push_back(rows);
    }
    std::vector<const TaskBody*> bodies() const override { return {&walking_, &plain_}; }
    std::vector<std::string> kinds() const override { return {"walking", "plain"}; }
    std::vector<RowTable*> tables() override { return {&table_}; }
    Step make_step(const Partition& partition) override {
        Step step;
        int region = 0;
        for (const Part& part : partition.parts) {
            for (TaskBody* body : {&walking_, &plain_}) {
                step.add(*body, 0, part.strips(), RegionId{region})
                    .updates(written_[static_cast<std::size_t>(body->kind)], strips_);
            }
            ++region;
        }
        step.seal();
        return step;
    }
    /// What each row of a strip wanted in the frame.
    void want(int strip, int entries) {
        const auto begin = table_.needs().data();
        std::fill(begin + strips_.item(strip), begin + strips_.item(strip + 1), entries);
    }

private:
    Buffer<int> begin_{"strips", kStrips + 1};
    Segments strips_ = even_strips(begin_, kItems);
    RowTable table_{"table", strips_, 2};
    std::array<Buffer<float>, 2> written_{Buffer<float>("a", kItems), Buffer<float>("b", kItems)};
    TaskBody walking_{"walking", 0, {Launch{}}}, plain_{"plain", 1, {Launch{}}};
};

TEST(RowItems, AreTheEntriesOfTheStripsOfTheLastFrame) {
    WorkWithRows work;
    RowItems items(work);
    const Step step = work.make_step(Partition{{{0, 3}, {3, kStrips}}});
    const auto all = [&] {
        std::vector<double> list;
        for (const Task& task : step.tasks()) list.push_back(items.of(task));
        return list;
    };
    EXPECT_EQ(all(), (std::vector<double>{30, 30, 10, 10}));
    work.want(0, 5);
    work.want(2, 1);
    work.want(3, 7);
    EXPECT_EQ(all(), (std::vector<double>{30, 30, 10, 10}));  // not before it is noted
    items.note();
    EXPECT_EQ(all(), (std::vector<double>{90, 30, 80, 10}));
    work.want(0, 0);
    items.note();
    EXPECT_EQ(all(), (std::vector<double>{40, 30, 80, 10}));
    EXPECT_TRUE(items.vary(0));
    EXPECT_FALSE(items.vary(1));
}

/// Rows grow twentyfold from one frame to the next, and each of their entries takes what an item
/// does: what the next frame takes is known from there on.
TEST(RowItems, CostsFollowRowsThatGrowAtOnce) {
    constexpr double kPerItem = 1e-6;
    WorkWithRows work;
    TimingModel timing(2, 1), blind(2, 1);
    timing.count_rows_of(work);
    const Step step = work.make_step(Partition{{{0, 2}, {2, kStrips}}});
    scheduler::Plan plan;
    for (std::size_t t = 0; t < step.tasks().size(); ++t) plan.placements.push_back({0, 0, 0});
    const auto take = [&](int entries) {
        for (int strip = 0; strip < kStrips; ++strip) work.want(strip, entries * (1 + strip / 2));
        RowItems now(work);
        RunTimes times;
        times.tasks.resize(1);
        double end = 0.0;
        for (std::size_t t = 0; t < step.tasks().size(); ++t) {
            const double start = end;
            end += kPerItem * now.of(step.tasks()[t]);
            times.tasks[0].push_back({0, static_cast<int>(t), start, end});
        }
        times.end = end;
        timing.learn(step, plan, times, 1);
        blind.learn(step, plan, times, 1);
    };
    for (int frame = 0; frame < 8; ++frame) take(1);
    take(20);
    const double taken = kPerItem * (20 + 20 * 20);
    EXPECT_NEAR(timing.task(step.tasks()[0], 0), taken, 0.01 * taken);
    EXPECT_LT(blind.task(step.tasks()[0], 0), 0.5 * taken);
    EXPECT_NEAR(timing.task(step.tasks()[1], 0), kPerItem * 20, 0.01 * kPerItem * 20);
}

/// The first device takes what entries take, the second one always the same. What that one tells
/// when rows have become shorter, that nothing has changed, holds for itself only: the first one is
/// tried, and found to be faster.
TEST(RowItems, ADeviceIsTriedWhereItemsSpeakForIt) {
    constexpr double kPerEntry = 1e-6;
    constexpr int kSubsteps = 8, kLong = 20, kShort = 5;
    WorkWithRows work;
    VirtualMachine machine({{0.0, kPerEntry}, {2e-4, 0.0}}, 0.0);
    FramePlanner planner(work, kStrips, machine.devices(), PlanKind::kSingle);
    const auto want = [&](int entries) {
        for (int strip = 0; strip < kStrips; ++strip) work.want(strip, entries);
        machine.speeds[0].by_kind = {1.0 + entries, 1.0};
    };
    const auto run = [&](const FramePlan& plan, int substeps) {
        planner.learn(plan, machine.run(plan, substeps), substeps);
    };
    const auto frame_on_first = [&] {
        const FramePlan& plan = planner.next();
        run(plan, kSubsteps);
        return plan.devices() == 1U;
    };
    want(2 * kLong);
    for (const FramePlan& plan : planner.calibration()) run(plan, 2);
    want(kLong);
    for (int i = 0; i < 20; ++i) frame_on_first();
    ASSERT_FALSE(frame_on_first());
    want(kShort);
    for (int i = 0; i < 20; ++i) frame_on_first();
    int stayed = 0;
    for (int i = 0; i < 20; ++i) stayed += frame_on_first() ? 1 : 0;
    EXPECT_GE(stayed, 16) << "but for a trial of the other one";
}

}  // namespace
}  // namespace weft::test
