#include "runtime/trace/recorded_graph.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/error.h"
#include "scheduler/heft.h"
#include "tests/runtime/trace/synthetic_run.h"

namespace weft {
namespace {

class RecordedGraph : public testing::Test {
protected:
    scheduler::TaskGraph rebuild(bool pinned = true) const {
        return rebuild_graph(run, frame, recorded_costs(run, frame), pinned);
    }

    RunDescription run = synthetic::describe({});
    FrameRecord frame = synthetic::frame({}, 1);
};

TEST_F(RecordedGraph, HasTheRecordedTasksEdgesAndLinks) {
    const auto graph = rebuild();
    ASSERT_EQ(graph.task_count(), frame.plan.size());
    const auto carried = [](const DependencyRecord& d) { return d.carried != 0; };
    const auto& dependencies = frame.graph->dependencies;
    EXPECT_EQ(graph.edge_count(),
              dependencies.size() - static_cast<std::size_t>(std::count_if(
                                        dependencies.begin(), dependencies.end(), carried)));
    EXPECT_EQ(graph.latency(0, 1), frame.links[0].latency);
    EXPECT_EQ(graph.latency(1, 0), frame.links[1].latency);
    for (const PlanRecord& task : frame.plan) {
        EXPECT_EQ(graph.name(task.task), task_name(run, task));
        EXPECT_EQ(graph.kind(task.task), static_cast<int>(task.kind));
        EXPECT_EQ(graph.iteration(task.task), static_cast<int>(task.iteration));
    }
}

TEST_F(RecordedGraph, CostsFollowItems) {
    const auto graph = rebuild(false);
    for (const PlanRecord& task : frame.plan) {
        for (const CostRecord& cost : frame.costs) {
            if (cost.kind != task.kind) continue;
            EXPECT_EQ(graph.cost(task.task, cost.device),
                      cost.fixed + cost.per_item * static_cast<double>(task.items));
        }
    }
}

TEST_F(RecordedGraph, PinnedTasksRunAtHomeOnly) {
    const auto pinned = rebuild(true);
    const auto free = rebuild(false);
    for (const PlanRecord& task : frame.plan) {
        for (std::uint32_t d = 0; d < 2; ++d) {
            EXPECT_EQ(pinned.can_run(task.task, d), d == task.home);
            EXPECT_TRUE(free.can_run(task.task, d));
        }
    }
    scheduler::Plan plan;
    scheduler::Heft().plan(pinned, plan);
    for (const PlanRecord& task : frame.plan) {
        EXPECT_EQ(plan.placements[task.task].processor, task.home);
    }
}

TEST_F(RecordedGraph, OfAnotherMachine) {
    MachineCosts costs({"a", "b", "c"}, run.kinds.size());
    for (auto& kind : costs.kinds) kind = {std::nullopt, std::nullopt, scheduler::LinearCost{1.0}};
    const auto graph = rebuild_graph(run, frame, costs, false);
    EXPECT_EQ(graph.processor_count(), 3U);
    EXPECT_FALSE(graph.can_run(0, 0));
    EXPECT_EQ(graph.cost(0, 2), 1.0);
    scheduler::Plan plan;
    scheduler::Heft().plan(graph, plan);
    EXPECT_EQ(plan.makespan, static_cast<double>(graph.task_count()));
    EXPECT_THROW(rebuild_graph(run, frame, costs, true), UserError);  // nobody may run it at home
}

TEST_F(RecordedGraph, SaysWhatATraceLacks) {
    const auto message = [&] {
        try {
            rebuild();
        } catch (const UserError& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    const FrameRecord whole = frame;
    frame.graph = nullptr;
    EXPECT_NE(message().find("frame 1: the trace holds no dependencies"), std::string::npos);
    frame = whole;
    frame.plan[3].kind = 99;
    EXPECT_NE(message().find("damaged"), std::string::npos);
    frame = whole;
    frame.plan.pop_back();
    EXPECT_NE(message().find("a dependency names a task that is not there"), std::string::npos);
    frame = whole;
    frame.costs[0].device = 7;
    EXPECT_NE(message().find("'costs' are damaged"), std::string::npos);
    frame = whole;
    frame.links[0].to = 7;
    EXPECT_NE(message().find("'links' are damaged"), std::string::npos);
    frame = whole;
    GraphRecord cycle = *frame.graph;
    cycle.dependencies.push_back({5, 0, 0, 1.0});
    cycle.dependencies.push_back({0, 5, 0, 1.0});
    frame.graph = std::make_shared<const GraphRecord>(cycle);
    EXPECT_NE(message().find("cycle"), std::string::npos);
}

}  // namespace
}  // namespace weft
