#include "scheduler/task_graph.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::scheduler {
namespace {

std::string error_of(const auto& action) {
    try {
        action();
    } catch (const GraphError& error) {
        return error.what();
    }
    return "no error";
}

TEST(TaskGraph, NamesAreOptional) {
    TaskGraph graph(1);
    graph.add_task(std::vector{1.0});
    graph.add_task(std::vector{1.0}, {.name = "b"});
    graph.add_task(std::vector{1.0});
    EXPECT_EQ(graph.label(0), "#0");
    EXPECT_EQ(graph.label(1), "b");
    EXPECT_EQ(graph.label(2), "#2");
    EXPECT_EQ(graph.name(2), "");
}

TEST(TaskGraph, MeanCostLeavesOutProcessorsThatCannotRun) {
    TaskGraph graph(3);
    graph.add_task(std::vector{2.0, kCannotRun, 4.0});
    EXPECT_EQ(graph.mean_cost(0), 3.0);
    EXPECT_FALSE(graph.can_run(0, 1));
}

TEST(TaskGraph, TransferTakesLatencyAndBandwidthOfThePair) {
    TaskGraph graph(2);
    graph.set_link(0, 1, 3.0, 2.0);
    graph.set_link(1, 0, 1.0, kCannotRun);
    EXPECT_EQ(graph.transfer_time(10.0, 0, 1), 8.0);
    EXPECT_EQ(graph.transfer_time(10.0, 1, 0), 1.0);
    EXPECT_EQ(graph.transfer_time(10.0, 1, 1), 0.0);
    EXPECT_EQ(graph.mean_transfer_time(10.0), 4.5);
}

TEST(TaskGraph, TopologicalOrderTakesTheLowestReadyTask) {
    TaskGraph graph(1);
    for (int i = 0; i < 5; ++i) graph.add_task(std::vector{1.0});
    graph.add_edge(4, 0, 0.0);
    graph.add_edge(3, 1, 0.0);
    graph.seal();
    const std::vector<TaskId> order(graph.topological_order().begin(),
                                    graph.topological_order().end());
    EXPECT_EQ(order, (std::vector<TaskId>{2, 3, 1, 4, 0}));
}

TEST(TaskGraph, CostsMayChangeOnceSealed) {
    TaskGraph graph(2);
    graph.add_task(std::vector{1.0, 2.0});
    graph.seal();
    graph.set_cost(0, std::vector{5.0, 7.0});
    EXPECT_TRUE(graph.sealed());
    EXPECT_EQ(graph.mean_cost(0), 6.0);
}

TEST(TaskGraph, NamesTheTasksOfACycle) {
    TaskGraph graph(1);
    for (const char* name : {"before", "a", "b", "c", "after"}) {
        graph.add_task(std::vector{1.0}, {.name = name});
    }
    graph.add_edge(0, 1, 0.0);
    graph.add_edge(1, 2, 0.0);
    graph.add_edge(2, 3, 0.0);
    graph.add_edge(3, 1, 0.0);
    graph.add_edge(3, 4, 0.0);
    EXPECT_EQ(error_of([&] { graph.seal(); }), "the tasks form a cycle: a -> b -> c -> a");
}

TEST(TaskGraph, RefusesWhatIsNoGraph) {
    TaskGraph graph(2);
    EXPECT_EQ(error_of([&] { graph.seal(); }), "the graph has no tasks");
    EXPECT_EQ(error_of([&] { TaskGraph(0); }), "a task graph needs at least one processor");
    EXPECT_EQ(error_of([&] { graph.add_task(std::vector{1.0}); }),
              "task #0: 1 costs for 2 processors");
    EXPECT_EQ(error_of([&] {
                  graph.add_task(std::vector{1.0, -2.0}, {.name = "a"});
              }),
              "task a: a cost must be >= 0, not -2.000000");
    EXPECT_EQ(error_of([&] {
                  graph.add_task(std::vector{kCannotRun, kCannotRun});
              }),
              "task #0: no processor can run it");
    graph.add_task(std::vector{1.0, 1.0});
    EXPECT_EQ(error_of([&] { graph.add_edge(0, 7, 1.0); }),
              "an edge names task #7, but there are only 1 tasks");
    EXPECT_EQ(error_of([&] { graph.add_edge(0, 0, std::nan("")); }),
              "edge #0 -> #0: data must be a finite number >= 0, not nan");
    EXPECT_EQ(error_of([&] { graph.set_links(-1.0, 1.0); }),
              "latency must be a time >= 0, not -1.000000");
    EXPECT_EQ(error_of([&] { graph.set_links(kCannotRun, 1.0); }),
              "latency must be a time >= 0, not inf");
    EXPECT_EQ(error_of([&] { graph.set_links(0.0, 0.0); }), "bandwidth must be > 0, not 0.000000");
    graph.add_edge(0, 0, 1.0);
    EXPECT_EQ(error_of([&] { graph.seal(); }), "the tasks form a cycle: #0 -> #0");
    EXPECT_EQ(graph.task_count(), 1u);
}

}  // namespace
}  // namespace weft::scheduler
