// What the paper adds to HEFT: merging, the Gauss-Seidel rank, the window of iterations.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "graphs.h"
#include "scheduler/heft.h"
#include "scheduler/iteration_window.h"
#include "scheduler/merging.h"
#include "scheduler/ranks.h"

namespace weft::scheduler::test {
namespace {

constexpr ProcessorId kCpu = 0, kGpu = 1;

/// Figure 3 of the paper: after a task on the CPU a chain of small bending tasks, t1 each on the
/// GPU and t2 > t1 on the CPU. A change of device costs tc, more than one task gains by it.
struct Figure3 {
    double t1 = 1.0, t2 = 2.0, tc = 2.5;
    TaskGraph graph{2};

    Figure3() {
        graph.set_links(tc, kCannotRun);  // a fixed delay, as in unified memory
        TaskId before = graph.add_task(std::vector{0.0, kCannotRun});
        for (int i = 0; i < 8; ++i) {
            const TaskId bend = graph.add_task(std::vector{t2, t1}, {.kind = 1, .iteration = 0});
            graph.add_edge(before, bend, 1.0);
            before = bend;
        }
        graph.seal();
    }
};

TEST(Merging, Figure3) {
    const Figure3 figure;
    Heft heft;
    Plan plan;
    heft.plan(figure.graph, plan);
    EXPECT_EQ(plan.makespan, 8 * figure.t2);  // the GPU idles

    TaskMerger merger;
    TaskGraph merged;
    merger.merge(figure.graph, 4 * figure.graph.mean_cost(1), merged);
    ASSERT_EQ(merged.task_count(), 3u);
    EXPECT_EQ(merger.tasks_of(1).size(), 4u);
    EXPECT_EQ(merger.tasks_of(2).size(), 4u);
    EXPECT_EQ(merged.cost(1, kGpu), 4 * figure.t1);
    heft.plan(merged, plan);
    EXPECT_EQ(plan.makespan, figure.tc + 8 * figure.t1);
    EXPECT_EQ(plan.placements[1].processor, kGpu);
    EXPECT_EQ(plan.placements[2].processor, kGpu);
}

TEST(Merging, KeepsApartWhatDiffers) {
    TaskGraph graph(2);
    const std::vector both{1.0, 1.0}, cpu_only{1.0, kCannotRun};
    graph.add_task(both, {.kind = 1, .iteration = 0});
    graph.add_task(both, {.kind = 1, .iteration = 1});      // another iteration
    graph.add_task(both, {.kind = 2, .iteration = 1});      // another kind
    graph.add_task(cpu_only, {.kind = 2, .iteration = 1});  // another set of processors
    graph.add_task(both);                                   // no kind
    graph.add_task(both);
    for (TaskId t = 0; t < 5; ++t) graph.add_edge(t, t + 1, 1.0);
    graph.seal();
    TaskMerger merger;
    TaskGraph merged;
    merger.merge(graph, 100.0, merged);
    EXPECT_EQ(merged.task_count(), graph.task_count());
}

TEST(Merging, MakesNoCycleAndLosesNothing) {
    TaskMerger merger;
    TaskGraph merged;
    for (std::uint32_t seed = 0; seed < 100; ++seed) {
        const TaskGraph source = random_graph({.tasks = 40, .shuffled = true}, seed);
        TaskGraph graph(source.processor_count());
        for (TaskId t = 0; t < source.task_count(); ++t) {
            graph.add_task(source.costs(t), {.kind = static_cast<std::int32_t>(t % 3)});
        }
        for (TaskId t = 0; t < source.task_count(); ++t) {
            for (const Arc& arc : source.successors(t)) graph.add_edge(t, arc.task, arc.data);
        }
        graph.seal();
        merger.merge(graph, 50.0, merged);  // seal() would find a cycle
        double before = 0.0, after = 0.0;
        for (TaskId t = 0; t < graph.task_count(); ++t) before += graph.cost(t, 0);
        for (TaskId t = 0; t < merged.task_count(); ++t) after += merged.cost(t, 0);
        EXPECT_NEAR(before, after, 1e-9 * before);
        EXPECT_LT(merged.task_count(), graph.task_count());
    }
}

/// Two kinds of tasks per iteration that only depend on their like of the iteration before, so that
/// iterations may overlap.
TaskGraph two_chains(int iterations) {
    TaskGraph graph(2);
    for (int i = 0; i < iterations; ++i) {
        graph.add_task(std::vector{5.0, 4.0}, {.kind = 0, .iteration = i});
        graph.add_task(std::vector{1.0, 1.0}, {.kind = 1, .iteration = i});
        const TaskId t = graph.task_count();
        if (i == 0) continue;
        graph.add_edge(t - 4, t - 2, 0.5);
        graph.add_edge(t - 3, t - 1, 0.5);
    }
    graph.seal();
    return graph;
}

/// How many iterations have begun and not ended, at most, by a plan.
int most_open(const TaskGraph& graph, const Plan& plan) {
    struct Span {
        double begin = kCannotRun, end = 0.0;
    };
    std::map<int, Span> spans;
    for (TaskId t = 0; t < graph.task_count(); ++t) {
        if (graph.iteration(t) < 0) continue;
        Span& span = spans[graph.iteration(t)];
        span.begin = std::min(span.begin, plan.placements[t].start);
        span.end = std::max(span.end, plan.placements[t].end);
    }
    int most = 0;
    for (const auto& [iteration, span] : spans) {
        most =
            std::max(most, static_cast<int>(std::ranges::count_if(spans, [&](const auto& other) {
                         return other.second.begin <= span.begin && span.begin < other.second.end;
                     })));
    }
    return most;
}

TEST(IterationWindow, KeepsAtMostSoManyOpen) {
    const TaskGraph graph = two_chains(8);
    Plan plan;
    Heft heft;
    heft.plan(graph, plan);
    ASSERT_GT(most_open(graph, plan), 3) << "the short chain runs ahead";
    const double unlimited = plan.makespan;

    IterationWindow window;
    TaskGraph limited;
    double last = kCannotRun;
    for (const int open : {1, 2, 3}) {
        window.limit(graph, open, limited);
        ASSERT_EQ(limited.task_count(), graph.task_count());
        heft.plan(limited, plan);
        EXPECT_EQ(complaint(limited, plan), "");
        EXPECT_EQ(complaint(graph, plan), "");
        EXPECT_LE(most_open(graph, plan), open);
        EXPECT_LE(plan.makespan, last) << "a larger window is never slower here";
        EXPECT_GE(plan.makespan, unlimited);
        last = plan.makespan;
    }
    window.limit(graph, 8, limited);
    EXPECT_EQ(limited.edge_count(), graph.edge_count()) << "no iteration is so far away";
}

TEST(IterationWindow, WaitsForAllThatWereOpenTogether) {
    // Tasks of iterations 0, 1, 2, 4 that depend on nothing. With two open, 4 waits for 1 and 2,
    // since 2 did not wait for 1.
    TaskGraph graph(1);
    for (const int iteration : {0, 1, 2, 4}) {
        graph.add_task(std::vector{1.0}, {.iteration = iteration});
    }
    graph.add_task(std::vector{1.0});  // of no iteration
    graph.seal();
    TaskGraph limited;
    IterationWindow().limit(graph, 2, limited);
    const auto waits_for = [&](TaskId task) {
        std::vector<TaskId> list;
        for (const Arc& arc : limited.predecessors(task)) list.push_back(arc.task);
        std::ranges::sort(list);
        return list;
    };
    EXPECT_EQ(waits_for(1), std::vector<TaskId>{});
    EXPECT_EQ(waits_for(2), (std::vector<TaskId>{0}));
    EXPECT_EQ(waits_for(3), (std::vector<TaskId>{1, 2}));
    EXPECT_EQ(waits_for(4), std::vector<TaskId>{});
}

TEST(IterationWindow, RefusesTasksThatWouldWaitForEachOther) {
    TaskGraph graph(1);
    graph.add_task(std::vector{1.0}, {.iteration = 0});
    graph.add_task(std::vector{1.0}, {.iteration = 1});
    graph.add_edge(1, 0, 0.0);
    graph.seal();
    TaskGraph limited;
    EXPECT_THROW(IterationWindow().limit(graph, 1, limited), GraphError);
}

TEST(GaussSeidelRank, LaterIterationsHaveSmallerRanks) {
    const TaskGraph graph = two_chains(4);
    std::vector<double> rank;
    upward_rank(graph, rank);
    EXPECT_GT(rank[2], rank[1]);  // the long chain overtakes the short one
    GaussSeidelRank()(graph, rank);
    for (TaskId t = 1; t < graph.task_count(); ++t) EXPECT_GT(rank[t - 1], rank[t]);
    Plan plan;
    Heft(Heft::Rank::kGaussSeidel).plan(graph, plan);
    EXPECT_EQ(complaint(graph, plan), "");
}

TEST(GaussSeidelRank, OtherTasksKeepTheirPlace) {
    TaskGraph graph(2);
    graph.add_task(std::vector{1.0, 1.0});  // before the iterations
    graph.add_task(std::vector{2.0, 2.0}, {.iteration = 1});
    graph.add_task(std::vector{3.0, 3.0}, {.iteration = 0});
    graph.add_task(std::vector{4.0, 4.0});  // after them
    graph.add_edge(0, 1, 1.0);
    graph.add_edge(0, 2, 1.0);
    graph.add_edge(1, 3, 1.0);
    graph.seal();
    std::vector<double> rank;
    GaussSeidelRank()(graph, rank);
    EXPECT_EQ(rank[3], 4.0);
    EXPECT_EQ(rank[1], 4.0 + 1.0 + 2.0);
    EXPECT_EQ(rank[2], rank[1] + 3.0);  // next in sequence, no communication
    EXPECT_EQ(rank[0], rank[2] + 1.0 + 1.0);
}

TEST(GaussSeidelRank, RefusesIterationsThatGoBack) {
    TaskGraph graph(1);
    graph.add_task(std::vector{1.0}, {.iteration = 1});
    graph.add_task(std::vector{1.0}, {.iteration = 0});
    graph.add_edge(0, 1, 0.0);
    graph.seal();
    std::vector<double> rank;
    EXPECT_THROW(GaussSeidelRank()(graph, rank), GraphError);
}

}  // namespace
}  // namespace weft::scheduler::test
