// Trials of what the plans leave out, and the times of plans under other costs.

#include "scheduler/trials.h"

#include <gtest/gtest.h>

#include <limits>

#include "scheduler/first_ready.h"
#include "scheduler/heft.h"
#include "scheduler/timetable.h"
#include "tests/scheduler/graphs.h"

namespace weft::scheduler {
namespace {

constexpr double kFrame = 1.0;

/// Two alternatives, of which the first one is chosen; gives how many frames the second one had,
/// and whether its trial ended well.
struct Course {
    int tried = 0;
    bool won = false;
};

/// second  [frame of the trial] what it takes; the last one goes on
Course run(Trials& trials, int frames, const std::vector<double>& second) {
    Course course;
    std::size_t at = 0;
    for (int i = 0; i < frames && !course.won; ++i) {
        const auto trial = trials.next(0, std::vector{kFrame, 1.1 * kFrame});
        double seconds = kFrame;
        if (trial) {
            seconds = second[std::min(at++, second.size() - 1)];
            ++course.tried;
        } else {
            at = 0;
        }
        trials.used(0);
        course.won = trials.end_frame(seconds, kFrame).has_value();
    }
    return course;
}

TEST(Trials, TheFirstFrameTellsNothing) {
    Trials trials(2, {.start_frames = 10.0});
    const Course course = run(trials, 20, {8.0, 0.5});
    EXPECT_TRUE(course.won);
    EXPECT_EQ(course.tried, 4);
}

TEST(Trials, EndsAtOnceWhereThereIsNoHope) {
    Trials trials(2, {.start_frames = 10.0});
    const Course course = run(trials, 20, {1.0, 3.0});
    EXPECT_FALSE(course.won);
    EXPECT_EQ(course.tried, 2);
}

TEST(Trials, EndOnceTheyCannotEndWell) {
    Trials lost(2, {.start_frames = 10.0});
    const Course course = run(lost, 20, {1.0, 1.1, 1.0, 0.5});
    EXPECT_FALSE(course.won);
    EXPECT_EQ(course.tried, 3);
    Trials open(2, {.start_frames = 10.0});
    EXPECT_EQ(run(open, 20, {1.0, 1.1, 0.5, 1.0}).tried, 4);
}

TEST(Trials, AreJudgedByTheMiddleOfTheLaterFrames) {
    Trials lucky(2, {.start_frames = 10.0});
    EXPECT_FALSE(run(lucky, 20, {1.0, 1.2, 0.5, 1.2}).won);
    Trials disturbed(2, {.start_frames = 10.0});
    EXPECT_TRUE(run(disturbed, 20, {1.0, 0.9, 1.3, 0.9}).won);
    Trials longer(2, {.start_frames = 10.0}, {.frames = 6});
    EXPECT_FALSE(run(longer, 20, {1.0, 0.9, 1.2, 0.9, 1.2, 1.2}).won);
}

TEST(Trials, CostNoMoreThanTheirShareOfTheTime) {
    Trials trials(2, {.start_frames = 1.0});
    constexpr int kFrames = 10000;
    double extra = 0.0;
    for (int i = 0; i < kFrames; ++i) {
        const double seconds = trials.next(0, std::vector{1.0, 1.2}) ? 1.4 : 1.0;
        extra += seconds - 1.0;
        trials.used(0);
        EXPECT_FALSE(trials.end_frame(seconds, 1.0).has_value());
    }
    EXPECT_GT(extra, 0.003 * kFrames);
    EXPECT_LT(extra, 0.01 * kFrames + 4.0);
}

/// What was lost by it has to be earned before the same one is tried again; others have no part in
/// it.
TEST(Trials, EndWhereAFrameIsGivenUp) {
    Trials trials(3, {.interval = 1, .price_share = 0.01, .start_frames = 1.0});
    const double impossible = std::numeric_limits<double>::infinity();
    const std::vector one{kFrame, impossible, kFrame}, other{kFrame, kFrame, impossible};
    trials.end_frame(kFrame, kFrame);
    ASSERT_EQ(trials.next(0, one), 2U);
    trials.give_up(3.0 * kFrame);
    EXPECT_FALSE(trials.running());
    trials.give_up(kFrame);  // there is no trial: nothing is charged

    trials.end_frame(kFrame, kFrame);
    ASSERT_EQ(trials.next(0, other), 1U);
    while (trials.running()) trials.end_frame(kFrame, kFrame);
    int frames = 0;
    while (!trials.next(0, one).has_value()) {
        trials.end_frame(kFrame, kFrame);
        ASSERT_LT(++frames, 1000);
    }
    EXPECT_NEAR(frames, 150, 10) << "its debt is paid back while credit is earned";
}

/// Where one forecast of several promises a gain, the trial comes before its time, at no price.
TEST(Trials, ComeEarlyWhereForecastsDisagree) {
    const auto frames_until = [](double hoped) {
        Trials trials(2, {.start_frames = 0.0});
        trials.used(1);
        int frames = 0;
        const std::vector expected{kFrame, 1.5 * kFrame};
        while (!trials.next(0, expected, std::vector{kFrame, hoped}).has_value() && frames < 1000) {
            trials.end_frame(kFrame, kFrame);
            ++frames;
        }
        return frames;
    };
    EXPECT_EQ(frames_until(0.8 * kFrame), 8);
    EXPECT_EQ(frames_until(0.95 * kFrame), 30);
    EXPECT_GT(frames_until(1.3 * kFrame), 30);
}

TEST(Trials, NeverTryWhatIsImpossibleOrInUse) {
    Trials trials(3, {.start_frames = 10.0});
    const double impossible = std::numeric_limits<double>::infinity();
    trials.used(2);
    for (int i = 0; i < 100; ++i) {
        EXPECT_FALSE(trials.next(0, std::vector{1.0, impossible, 1.0}).has_value());
        trials.used(0);
        trials.used(2);
        trials.end_frame(1.0, 1.0);
    }
}

/// With the costs that it was made with, a plan takes what it says.
TEST(Timetable, AgreesWithThePlansOwnTimes) {
    Heft heft;
    FirstReady first_ready;
    Timetable timetable;
    for (std::uint32_t seed = 0; seed < 50; ++seed) {
        const TaskGraph graph = test::random_graph({.tasks = 30, .processors = 3}, seed);
        Plan plan;
        heft.schedule(graph, plan);
        const double planned = plan.makespan;
        std::vector<double> cost;
        const auto read_costs = [&] {
            cost.clear();
            for (TaskId t = 0; t < graph.task_count(); ++t) {
                cost.push_back(graph.cost(t, plan.placements[t].processor));
            }
        };
        read_costs();
        // Insertion leaves no gap that the order would not leave; what is behind one may move up.
        EXPECT_LE(timetable.makespan(graph, plan, cost), planned * (1.0 + 1e-12)) << seed;
        for (double& c : cost) c *= 2.0;
        EXPECT_GT(timetable.makespan(graph, plan, cost), planned) << seed;

        first_ready.order(graph, plan);
        read_costs();
        EXPECT_NEAR(timetable.makespan(graph, plan, cost), plan.makespan, 1e-12 * planned) << seed;
        EXPECT_EQ(plan.order.size(), graph.task_count());
    }
}

/// a on one processor, then b on the other; the next a needs the a before, and nothing else.
TEST(Timetable, InstancesOverlap) {
    TaskGraph graph(2);
    graph.set_links(0.5, 1e9);
    const TaskId a = graph.add_task(std::vector{2.0, kCannotRun});
    const TaskId b = graph.add_task(std::vector{kCannotRun, 3.0});
    graph.add_edge(a, b, 0.0);
    graph.seal();
    Plan plan;
    Heft().schedule(graph, plan);
    Timetable timetable;
    const std::vector cost{2.0, 3.0};
    EXPECT_DOUBLE_EQ(timetable.makespan(graph, plan, cost), 5.5);
    EXPECT_DOUBLE_EQ(timetable.period(graph, plan, cost, {}), 3.0);
    const std::vector<CarriedEdge> back{{b, a, 0.0}};
    EXPECT_DOUBLE_EQ(timetable.period(graph, plan, cost, back), 6.0);
}

}  // namespace
}  // namespace weft::scheduler
