#include <algorithm>

#include "scheduler/exchange_map.h"

namespace weft::scheduler {

namespace {

bool meet(const std::vector<CellRange>& a, const std::vector<CellRange>& b) {
    return std::ranges::any_of(a, [&](const CellRange& one) {
        return std::ranges::any_of(b, [&](const CellRange& other) {
            return one.begin < other.end && other.begin < one.end;
        });
    });
}

bool must_see(const ExchangeTask& later, const ExchangeTask& earlier, int window) {
    if (window == 1 || later.synchronous || earlier.synchronous) return true;
    if (earlier.iteration == later.iteration) return earlier.stage < later.stage;
    return earlier.iteration <= later.iteration - window;
}

}  // namespace

std::vector<std::vector<int>> needed_tasks(const ExchangeProblem& problem) {
    const auto& tasks = problem.tasks;
    std::vector<std::vector<int>> needed(tasks.size());
    for (std::size_t t = 0; t < tasks.size(); ++t) {
        for (std::size_t u = 0; u < t; ++u) {
            if (tasks[u].device == tasks[t].device) continue;
            if (!must_see(tasks[t], tasks[u], problem.window)) continue;
            if (meet(tasks[u].writes, tasks[t].reads)) needed[t].push_back(static_cast<int>(u));
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

}  // namespace weft::scheduler
