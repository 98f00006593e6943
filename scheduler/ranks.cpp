#include "scheduler/ranks.h"

#include <algorithm>

namespace weft::scheduler {
namespace {

constexpr TaskId kNone = ~TaskId{0};

double rank_below(const TaskGraph& graph, std::span<const double> rank, TaskId task) {
    double below = 0.0;
    for (const Arc& arc : graph.successors(task)) {
        below = std::max(below, arc.mean_time + rank[arc.task]);
    }
    return below;
}

}  // namespace

void upward_rank(const TaskGraph& graph, std::vector<double>& rank) {
    rank.resize(graph.task_count());
    const std::span<const TaskId> forwards = graph.topological_order();
    for (auto each = forwards.rbegin(); each != forwards.rend(); ++each) {
        const TaskId t = *each;
        rank[t] = graph.mean_cost(t) + rank_below(graph, rank, t);
    }
}

void downward_rank(const TaskGraph& graph, std::vector<double>& rank) {
    rank.resize(graph.task_count());
    for (const TaskId t : graph.topological_order()) {
        rank[t] = 0.0;
        for (const Arc& arc : graph.predecessors(t)) {
            const double above = rank[arc.task] + graph.mean_cost(arc.task) + arc.mean_time;
            rank[t] = std::max(rank[t], above);
        }
    }
}

void GaussSeidelRank::link_iterations(const TaskGraph& graph) {
    const TaskId n = graph.task_count();
    sequence_.clear();
    for (const TaskId t : graph.topological_order()) {
        if (graph.iteration(t) >= 0) sequence_.push_back(t);
    }
    // Sorting by both keys rather than stably: std::stable_sort allocates.
    std::sort(sequence_.begin(), sequence_.end(), [&](TaskId a, TaskId b) {
        if (graph.iteration(a) != graph.iteration(b))
            return graph.iteration(a) < graph.iteration(b);
        return graph.topological_index(a) < graph.topological_index(b);
    });
    next_.assign(n, kNone);
    previous_.assign(n, kNone);
    for (std::size_t i = 1; i < sequence_.size(); ++i) {
        next_[sequence_[i - 1]] = sequence_[i];
        previous_[sequence_[i]] = sequence_[i - 1];
    }
}

void GaussSeidelRank::operator()(const TaskGraph& graph, std::vector<double>& rank) {
    const TaskId n = graph.task_count();
    link_iterations(graph);
    rank.resize(n);
    open_.resize(n);
    stack_.clear();
    for (TaskId t = 0; t < n; ++t) {
        open_[t] = static_cast<std::uint32_t>(graph.successors(t).size()) + (next_[t] != kNone);
        if (open_[t] == 0) stack_.push_back(t);
    }
    TaskId ranked = 0;
    const auto close = [&](TaskId t) {
        if (--open_[t] == 0) stack_.push_back(t);
    };
    while (!stack_.empty()) {
        const TaskId t = stack_.back();
        stack_.pop_back();
        const double later = next_[t] == kNone ? 0.0 : rank[next_[t]];
        rank[t] = graph.mean_cost(t) + std::max(rank_below(graph, rank, t), later);
        ++ranked;
        for (const Arc& arc : graph.predecessors(t)) close(arc.task);
        if (previous_[t] != kNone) close(previous_[t]);
    }
    if (ranked < n) throw GraphError("a task depends on a task of a later iteration");
}

void optimistic_cost_table(const TaskGraph& graph, std::vector<double>& table,
                           std::vector<double>& rank) {
    const ProcessorId processors = graph.processor_count();
    table.assign(std::size_t{graph.task_count()} * processors, 0.0);
    rank.resize(graph.task_count());
    const std::span<const TaskId> forwards = graph.topological_order();
    for (auto each = forwards.rbegin(); each != forwards.rend(); ++each) {
        const TaskId t = *each;
        double* own = table.data() + std::size_t{t} * processors;
        for (const Arc& arc : graph.successors(t)) {
            const double* next = table.data() + std::size_t{arc.task} * processors;
            double anywhere = kCannotRun;
            for (ProcessorId q = 0; q < processors; ++q) {
                anywhere = std::min(anywhere, next[q] + graph.cost(arc.task, q));
            }
            // The best q with communication, or p itself without.
            for (ProcessorId p = 0; p < processors; ++p) {
                const double here = next[p] + graph.cost(arc.task, p);
                own[p] = std::max(own[p], std::min(here, anywhere + arc.mean_time));
            }
        }
        double sum = 0.0;
        int able = 0;
        for (ProcessorId p = 0; p < processors; ++p) {
            if (!graph.can_run(t, p)) continue;
            sum += own[p];
            ++able;
        }
        rank[t] = sum / able;
    }
}

void order_by_rank(const TaskGraph& graph, std::span<const double> rank,
                   std::vector<TaskId>& order) {
    const std::span<const TaskId> topological = graph.topological_order();
    order.assign(topological.begin(), topological.end());
    std::sort(order.begin(), order.end(), [&](TaskId a, TaskId b) {
        if (rank[a] != rank[b]) return rank[a] > rank[b];
        return graph.topological_index(a) < graph.topological_index(b);
    });
}

}  // namespace weft::scheduler
