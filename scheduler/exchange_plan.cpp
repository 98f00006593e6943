#include <algorithm>
#include <limits>

#include "scheduler/exchange_map.h"
#include "scheduler/heft.h"

namespace weft::scheduler {

namespace {

bool meet(const std::vector<CellRange>& a, const std::vector<CellRange>& b) {
    return std::ranges::any_of(a, [&](const CellRange& one) {
        return std::ranges::any_of(b, [&](const CellRange& other) {
            return one.begin < other.end && other.begin < one.end;
        });
    });
}

bool must_see(const ExchangeProblem& problem, const ExchangeTask& later,
              const ExchangeTask& earlier) {
    if (problem.window == 1 || later.synchronous || earlier.synchronous) return true;
    if (later.kind >= 0 && later.kind == earlier.kind) return true;
    if (earlier.iteration == later.iteration) return earlier.stage < later.stage;
    return earlier.iteration <= later.iteration - (problem.iterations_in_turn ? 1 : problem.window);
}

/// Whether task t, wherever it is done, needs what task u, before it, has written.
bool needs(const ExchangeProblem& problem, std::size_t t, std::size_t u) {
    const ExchangeTask& later = problem.tasks[t];
    const ExchangeTask& earlier = problem.tasks[u];
    return must_see(problem, later, earlier) && meet(earlier.writes, later.reads);
}

TaskGraph graph_of(const ExchangeProblem& problem,
                   const std::vector<std::vector<double>>& durations) {
    TaskGraph graph(static_cast<ProcessorId>(problem.devices));
    graph.set_links(problem.wait, std::numeric_limits<double>::infinity());
    for (std::size_t t = 0; t < problem.tasks.size(); ++t) {
        graph.add_task(durations[t], {.iteration = problem.tasks[t].iteration});
    }
    for (std::size_t t = 0; t < problem.tasks.size(); ++t) {
        const auto add_edge = [&](std::size_t u) {
            graph.add_edge(static_cast<TaskId>(u), static_cast<TaskId>(t), 0.0);
        };
        for (std::size_t u = 0; u < t; ++u) {
            if (needs(problem, t, u)) add_edge(u);
        }
        for (const int u : problem.tasks[t].after) add_edge(static_cast<std::size_t>(u));
    }
    graph.seal();
    return graph;
}

}  // namespace

std::vector<std::vector<int>> needed_tasks(const ExchangeProblem& problem) {
    const auto& tasks = problem.tasks;
    std::vector<std::vector<int>> needed(tasks.size());
    for (std::size_t t = 0; t < tasks.size(); ++t) {
        for (std::size_t u = 0; u < t; ++u) {
            if (tasks[u].device == tasks[t].device) continue;
            if (needs(problem, t, u)) needed[t].push_back(static_cast<int>(u));
        }
    }
    return needed;
}

void plan_in_turn(ExchangeProblem& problem, const std::vector<double>& durations) {
    const auto needed = needed_tasks(problem);
    std::vector<double> free(static_cast<std::size_t>(problem.devices), 0.0);
    for (std::size_t t = 0; t < problem.tasks.size(); ++t) {
        ExchangeTask& task = problem.tasks[t];
        double& next = free[static_cast<std::size_t>(task.device)];
        task.start = next;
        const auto wait_for = [&](int u) {
            const ExchangeTask& other = problem.tasks[static_cast<std::size_t>(u)];
            const double wait = other.device == task.device ? 0.0 : problem.wait;
            task.start = std::max(task.start, other.end + wait);
        };
        std::ranges::for_each(needed[t], wait_for);
        std::ranges::for_each(task.after, wait_for);
        task.end = next = task.start + durations[t];
    }
}

void place_by_rank(ExchangeProblem& problem, const std::vector<std::vector<double>>& durations,
                   PlacingRank rank) {
    Plan plan;
    const bool in_sequence = rank == PlacingRank::kGaussSeidel;
    Heft(in_sequence ? Heft::Rank::kGaussSeidel : Heft::Rank::kUpward)
        .schedule(graph_of(problem, durations), plan);
    for (std::size_t t = 0; t < problem.tasks.size(); ++t) {
        ExchangeTask& task = problem.tasks[t];
        task.device = static_cast<int>(plan.placements[t].processor);
        task.start = plan.placements[t].start;
        task.end = plan.placements[t].end;
    }
}

}  // namespace weft::scheduler
