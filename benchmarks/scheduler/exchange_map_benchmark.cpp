// What planning asynchronous iterations takes: placing tasks by the Gauss-Seidel rank, and the map
// of who feeds whom. The aim, on one core of a 2020s server: under 0.1 ms for the paper's graphs,
// of 4 iterations on two devices (figures 9 to 13 show two of them).

#include <benchmark/benchmark.h>

#include "scheduler/exchange_map.h"

namespace weft::scheduler {
namespace {

void add(ExchangeProblem& problem, int iteration, int kind, int device, CellRange cells,
         bool synchronous) {
    ExchangeTask task;
    task.iteration = iteration;
    task.kind = kind;
    task.device = device;
    task.synchronous = synchronous;
    task.reads = task.writes = {cells};
    problem.tasks.push_back(task);
}

/// As the paper's figure 2: stretching of seams and strips, bending likewise, and obstacles, which
/// see the rest of their iteration; all of them move all.
ExchangeProblem by_kinds(int iterations) {
    constexpr int kKinds = 5;
    ExchangeProblem problem;
    problem.devices = 2;
    problem.wait = 0.2;
    problem.dropping = false;
    problem.most_slots = 40;
    problem.owners = {0};
    add(problem, 0, -1, 0, {0, 1}, true);
    for (int i = 0; i < iterations; ++i) {
        for (int kind = 0; kind < kKinds; ++kind) {
            add(problem, i, kind, 0, {0, 1}, false);
            problem.tasks.back().stage = kind + 1 == kKinds ? 1 : 0;
        }
    }
    add(problem, iterations - 1, -1, 0, {0, 1}, true);
    return problem;
}

/// As Weft's: every device has a cell of its own and one at each cut, and a task for either.
ExchangeProblem by_strips(int devices, int iterations) {
    ExchangeProblem problem;
    problem.devices = devices;
    problem.wait = 1.0;
    problem.dropping = false;
    for (int d = 0; d < devices; ++d) problem.owners.insert(problem.owners.end(), 3, d);
    for (int d = 0; d < devices; ++d) add(problem, 0, -1, d, {3 * d, 3 * d + 3}, true);
    for (int i = 0; i < iterations; ++i) {
        for (int d = 0; d < devices; ++d) {
            if (d + 1 < devices) add(problem, i, -1, d, {3 * d + 2, 3 * d + 4}, false);
            add(problem, i, -1, d, {3 * d, 3 * d + 3}, false);
        }
    }
    for (int d = 0; d < devices; ++d) add(problem, iterations - 1, -1, d, {3 * d, 3 * d + 3}, true);
    problem.most_slots = 12;
    return problem;
}

/// Arguments: iterations.
void plan_by_kinds(benchmark::State& state) {
    const ExchangeProblem unplanned = by_kinds(static_cast<int>(state.range(0)));
    const std::vector<std::vector<double>> durations(unplanned.tasks.size(), {0.2, 0.2});
    for (auto _ : state) {
        ExchangeProblem problem = unplanned;
        place_by_rank(problem, durations, PlacingRank::kGaussSeidel);
        benchmark::DoNotOptimize(make_exchange_map(problem).steps.data());
    }
    state.counters["tasks"] = static_cast<double>(unplanned.tasks.size());
}

/// Arguments: devices, iterations.
void plan_by_strips(benchmark::State& state) {
    const ExchangeProblem unplanned =
        by_strips(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
    const std::vector<double> durations(unplanned.tasks.size(), 0.5);
    for (auto _ : state) {
        ExchangeProblem problem = unplanned;
        plan_in_turn(problem, durations);
        benchmark::DoNotOptimize(make_exchange_map(problem).steps.data());
    }
    state.counters["tasks"] = static_cast<double>(unplanned.tasks.size());
}

BENCHMARK(plan_by_kinds)
    ->Name("exchange_map_by_kinds")
    ->ArgName("iterations")
    ->Unit(benchmark::kMicrosecond)
    ->Arg(2)
    ->Arg(4)
    ->Arg(8)
    ->Arg(20);
BENCHMARK(plan_by_strips)
    ->Name("exchange_map_by_strips")
    ->ArgNames({"devices", "iterations"})
    ->Unit(benchmark::kMicrosecond)
    ->Args({2, 8})
    ->Args({3, 8})
    ->Args({3, 32});

}  // namespace
}  // namespace weft::scheduler
