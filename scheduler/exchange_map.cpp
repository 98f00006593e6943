#include "scheduler/exchange_map.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "scheduler/cell_exchange.h"
#include "scheduler/cell_places.h"

namespace weft::scheduler {

namespace {

/// Steps of cells side by side that are the same become one.
class Joined {
public:
    void add(const StepsByTask& steps, int task, int cell) {
        const auto found = steps.find(task);
        if (found == steps.end()) return;
        if (rows_.empty() || end_ != cell || rows_.back() != found->second) {
            rows_.push_back(found->second);
            begins_.push_back(cell);
            ends_.push_back(cell);
        }
        end_ = ends_.back() = cell + 1;
    }
    void append_to(std::vector<ExchangeStep>& list) const {
        for (std::size_t r = 0; r < rows_.size(); ++r) {
            for (ExchangeStep step : rows_[r]) {
                step.cells = {begins_[r], ends_[r]};
                list.push_back(step);
            }
        }
    }

private:
    std::vector<std::vector<ExchangeStep>> rows_;
    std::vector<int> begins_, ends_;
    int end_ = -1;
};

std::vector<int> order_of_starts(const ExchangeProblem& problem) {
    std::vector<int> order(problem.tasks.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(
        order, {}, [&](int t) { return problem.tasks[static_cast<std::size_t>(t)].start; });
    return order;
}

bool covers(const std::vector<CellRange>& ranges, int cell) {
    return std::ranges::any_of(ranges,
                               [&](const CellRange& r) { return r.begin <= cell && cell < r.end; });
}

void check_times(const ExchangeProblem& problem, const std::vector<std::vector<int>>& needed) {
    for (std::size_t t = 0; t < needed.size(); ++t) {
        for (const int u : needed[t]) {
            const double end = problem.tasks[static_cast<std::size_t>(u)].end;
            if (problem.tasks[t].start >= end) continue;
            throw std::logic_error("exchange map: task " + std::to_string(t) +
                                   " starts before task " + std::to_string(u) +
                                   ", which it needs, has ended");
        }
    }
}

}  // namespace

ExchangeMap make_exchange_map(const ExchangeProblem& problem) {
    const auto needed = needed_tasks(problem);
    check_times(problem, needed);
    const std::vector<int> order = order_of_starts(problem);
    double end = 0.0;
    for (const ExchangeTask& task : problem.tasks) end = std::max(end, task.end);

    std::vector<CellSteps> cells;
    ExchangeMap map;
    for (int c = 0; c < static_cast<int>(problem.owners.size()); ++c) {
        CellExchange cell(problem, needed, c);
        for (const int t : order) {
            const ExchangeTask& task = problem.tasks[static_cast<std::size_t>(t)];
            if (covers(task.reads, c)) cell.run(t, covers(task.writes, c));
        }
        cell.end(end);
        const CellSteps& steps = cells.emplace_back(CellPlaces(problem, cell).steps(order.front()));
        map.slots = std::max(map.slots, steps.slots);
        map.virtual_starts += steps.virtual_starts;
    }
    const auto add = [&](int task, bool behind) {
        Joined joined;
        for (std::size_t c = 0; c < cells.size(); ++c) {
            joined.add(behind ? cells[c].behind : cells[c].before, task, static_cast<int>(c));
        }
        joined.append_to(map.steps);
    };
    for (const int t : order) {
        add(t, false);
        ExchangeStep step;
        step.task = t;
        step.device = problem.tasks[static_cast<std::size_t>(t)].device;
        map.steps.push_back(step);
        add(t, true);
    }
    add(static_cast<int>(problem.tasks.size()), false);
    return map;
}

}  // namespace weft::scheduler
