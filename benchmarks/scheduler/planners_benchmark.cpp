// Planning time. Arguments: tasks, processors. The aims, on one core of a 2020s server:
//   HEFT, bounds included: 30 x 2 under 5 us, 100 x 2 under 20 us, 1000 x 4 under 0.6 ms,
//   10000 x 4 under 20 ms.

#include <benchmark/benchmark.h>

#include <random>

#include "scheduler/heft.h"
#include "scheduler/portfolio.h"

namespace weft::scheduler {
namespace {

/// Like a substep: chains of tasks that exchange data with their neighbours now and then, about two
/// edges per task. Costs and communication are alike.
void build(TaskGraph& graph, TaskId tasks, ProcessorId processors) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> cost(1.0, 20.0);
    graph.clear(processors);
    std::vector<double> costs(processors);
    for (TaskId t = 0; t < tasks; ++t) {
        for (double& c : costs) c = cost(random);
        graph.add_task(costs, {});
    }
    const TaskId width = std::max<TaskId>(2, tasks / 10);
    for (TaskId t = 0; t + width < tasks; ++t) {
        graph.add_edge(t, t + width, cost(random));
        if (t + width + 1 < tasks) graph.add_edge(t, t + width + 1, cost(random));
    }
    graph.seal();
}

template <class P>
void plan(benchmark::State& state) {
    TaskGraph graph;
    build(graph, static_cast<TaskId>(state.range(0)), static_cast<ProcessorId>(state.range(1)));
    P planner;
    Plan result;
    for (auto _ : state) {
        planner.plan(graph, result);
        benchmark::DoNotOptimize(result.makespan);
    }
}

/// Without the bounds: what the runtime does for each candidate cut.
void schedule_heft(benchmark::State& state) {
    TaskGraph graph;
    build(graph, static_cast<TaskId>(state.range(0)), static_cast<ProcessorId>(state.range(1)));
    Heft planner;
    Plan result;
    for (auto _ : state) {
        planner.schedule(graph, result);
        benchmark::DoNotOptimize(result.makespan);
    }
}

void build_graph(benchmark::State& state) {
    TaskGraph source;
    build(source, static_cast<TaskId>(state.range(0)), static_cast<ProcessorId>(state.range(1)));
    TaskGraph graph;
    for (auto _ : state) {
        graph.clear(source.processor_count());
        for (TaskId t = 0; t < source.task_count(); ++t) graph.add_task(source.costs(t));
        for (TaskId t = 0; t < source.task_count(); ++t) {
            for (const Arc& arc : source.successors(t)) graph.add_edge(t, arc.task, arc.data);
        }
        graph.seal();
        benchmark::DoNotOptimize(graph.topological_order().data());
    }
}

void area_bound(benchmark::State& state) {
    TaskGraph graph;
    build(graph, static_cast<TaskId>(state.range(0)), static_cast<ProcessorId>(state.range(1)));
    LowerBounds bounds;
    for (auto _ : state) benchmark::DoNotOptimize(bounds.area(graph));
}

void path_bound(benchmark::State& state) {
    TaskGraph graph;
    build(graph, static_cast<TaskId>(state.range(0)), static_cast<ProcessorId>(state.range(1)));
    LowerBounds bounds;
    for (auto _ : state) benchmark::DoNotOptimize(bounds.path(graph));
}

void portfolio(benchmark::State& state) {
    TaskGraph graph;
    build(graph, static_cast<TaskId>(state.range(0)), static_cast<ProcessorId>(state.range(1)));
    Portfolio planner({.evaluations = static_cast<std::uint32_t>(state.range(2))});
    Plan result;
    for (auto _ : state) {
        planner.plan(graph, result);
        benchmark::DoNotOptimize(result.makespan);
    }
}

void sizes(benchmark::internal::Benchmark* bench) {
    bench->ArgNames({"tasks", "processors"})->Unit(benchmark::kMicrosecond);
    bench->Args({30, 2})->Args({60, 2})->Args({100, 2})->Args({1000, 4})->Args({10000, 4});
}

BENCHMARK(plan<Heft>)->Name("heft")->Apply(sizes);
BENCHMARK(schedule_heft)->Name("heft_without_bounds")->Apply(sizes);
BENCHMARK(plan<Peft>)->Name("peft")->Apply(sizes);
BENCHMARK(plan<Cpop>)->Name("cpop")->Apply(sizes);
BENCHMARK(plan<Hps>)->Name("hps")->Apply(sizes);
BENCHMARK(plan<Lookahead>)->Name("lookahead")->Apply(sizes);
BENCHMARK(build_graph)->Apply(sizes);
BENCHMARK(area_bound)->Apply(sizes);
BENCHMARK(path_bound)->Apply(sizes);
BENCHMARK(portfolio)
    ->ArgNames({"tasks", "processors", "evaluations"})
    ->Unit(benchmark::kMicrosecond)
    ->Args({10, 2, 2000})
    ->Args({60, 2, 5})
    ->Args({60, 2, 20})
    ->Args({60, 2, 100});

}  // namespace
}  // namespace weft::scheduler
