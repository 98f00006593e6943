// Planning every frame must not allocate once it has warmed up: operator new is counted.

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "graphs.h"
#include "scheduler/cost_model.h"
#include "scheduler/merging.h"
#include "scheduler/planner.h"
#include "scheduler/portfolio.h"

namespace {
std::size_t allocations = 0;

void* counted(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace weft::scheduler::test {
namespace {

void rebuild(TaskGraph& graph, const TaskGraph& source) {
    graph.clear(source.processor_count());
    graph.set_links(1.0, 2.0);
    for (TaskId t = 0; t < source.task_count(); ++t) {
        graph.add_task(source.costs(t), {.kind = static_cast<std::int32_t>(t % 4), .iteration = 0});
    }
    for (TaskId t = 0; t < source.task_count(); ++t) {
        for (const Arc& arc : source.successors(t)) graph.add_edge(t, arc.task, arc.data);
    }
    graph.seal();
}

template <class Frame>
std::size_t allocations_of_a_later_frame(const Frame& frame) {
    for (int warm_up = 0; warm_up < 3; ++warm_up) frame();
    const std::size_t before = allocations;
    frame();
    return allocations - before;
}

TEST(SteadyState, PlannersDoNotAllocate) {
    const TaskGraph source = random_graph({.tasks = 60, .processors = 2}, 1);
    TaskGraph graph;
    Plan plan;
    for (const std::string_view name : planner_names()) {
        if (name == "optimal" || name == "portfolio") continue;
        const auto planner = make_planner(name);
        EXPECT_EQ(0u, allocations_of_a_later_frame([&] {
                      rebuild(graph, source);
                      planner->plan(graph, plan);
                  }))
            << name;
    }
    Portfolio portfolio({.evaluations = 50, .seconds = 1.0});
    EXPECT_EQ(0u, allocations_of_a_later_frame([&] {
                  rebuild(graph, source);
                  portfolio.plan(graph, plan);
              }));
    Heft gauss_seidel(Heft::Rank::kGaussSeidel);
    EXPECT_EQ(0u, allocations_of_a_later_frame([&] { gauss_seidel.plan(graph, plan); }));
}

TEST(SteadyState, MergingDoesNotAllocate) {
    const TaskGraph source = random_graph({.tasks = 60, .processors = 2}, 1);
    TaskGraph graph, merged;
    rebuild(graph, source);
    TaskMerger merger;
    Heft heft;
    Plan plan;
    EXPECT_EQ(0u, allocations_of_a_later_frame([&] {
                  merger.merge(graph, 30.0, merged);
                  heft.plan(merged, plan);
              }));
}

TEST(SteadyState, TheCostModelDoesNotAllocate) {
    CostModel model(20, 2);
    EXPECT_EQ(0u, allocations_of_a_later_frame([&] {
                  for (std::uint32_t i = 0; i < 1000; ++i) {
                      model.observe(i % 20, i % 2, 100.0 + i, 1e-6 * i);
                  }
                  model.refit();
              }));
}

}  // namespace
}  // namespace weft::scheduler::test
