#include "scheduler/local_search.h"

#include <algorithm>
#include <cmath>

namespace weft::scheduler {
namespace {

constexpr std::uint32_t kTimeCheck = 16;  // evaluations between two looks at the clock

/// Largest increase of the makespan, relative to the best one, that is accepted at the beginning.
/// Found by trials on random graphs of 10 to 200 tasks: the more tasks there are, the less a change
/// of one may cost.
double first_rise(TaskId tasks) {
    const double share = 10.0 / tasks;
    return std::min(1.0, share * std::sqrt(share));
}

}  // namespace

bool LocalSearch::improve(const TaskGraph& graph, Plan& plan, std::uint32_t evaluations,
                          double bound, const std::function<bool()>& out_of_time) {
    if (graph.task_count() < 2 || evaluations == 0 || plan.makespan <= bound) return false;
    start_from(graph, plan);
    const double before = plan.makespan;
    double current = evaluate(graph, kCannotRun);
    const auto accept = [&](double makespan) {
        current = makespan;
        find_critical_chain(graph);
        if (makespan < plan.makespan) builder_.finish(plan, plan.algorithm);
    };
    accept(current);  // placing the plan's tasks anew, with insertion, may have closed gaps
    const double hottest = first_rise(graph.task_count());
    for (std::uint32_t i = 1; i < evaluations && plan.makespan > bound; ++i) {
        if (out_of_time && i % kTimeCheck == 0 && out_of_time()) break;
        if (!change(graph)) continue;
        const double left = 1.0 - static_cast<double>(i) / evaluations;
        const double dice = random_below(1u << 16) * 0x1p-16;
        const double rise = hottest * left * left * dice * dice * dice;
        const double limit = current + rise * plan.makespan;
        const double makespan = evaluate(graph, limit);
        if (makespan <= limit) {
            accept(makespan);
        } else {
            undo();
        }
    }
    return plan.makespan < before;
}

void LocalSearch::start_from(const TaskGraph& graph, const Plan& plan) {
    const TaskId n = graph.task_count();
    order_.resize(n);
    for (TaskId t = 0; t < n; ++t) order_[t] = t;
    std::sort(order_.begin(), order_.end(), [&](TaskId a, TaskId b) {
        if (plan.placements[a].start != plan.placements[b].start) {
            return plan.placements[a].start < plan.placements[b].start;
        }
        return graph.topological_index(a) < graph.topological_index(b);
    });
    position_.resize(n);
    processor_.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) {
        position_[order_[i]] = i;
        processor_[i] = plan.placements[i].processor;
    }
    find_tails(graph);
    random_ = 0x9e3779b97f4a7c15u;
}

void LocalSearch::find_tails(const TaskGraph& graph) {
    tail_.assign(graph.task_count(), 0.0);
    const std::span<const TaskId> forwards = graph.topological_order();
    for (auto each = forwards.rbegin(); each != forwards.rend(); ++each) {
        const TaskId t = *each;
        const std::span<const double> costs = graph.costs(t);
        const double from_start = tail_[t] + *std::min_element(costs.begin(), costs.end());
        for (const Arc& arc : graph.predecessors(t)) {
            tail_[arc.task] = std::max(tail_[arc.task], from_start);
        }
    }
}

// From a task that ends last, back through whatever each task had to wait for.
void LocalSearch::find_critical_chain(const TaskGraph& graph) {
    chain_.clear();
    TaskId task = order_.front();
    for (const TaskId t : order_) {
        if (builder_.placement(t).end > builder_.placement(task).end) task = t;
    }
    for (bool found = true; found;) {
        chain_.push_back(task);
        found = false;
        const Placement own = builder_.placement(task);
        if (own.start <= 0.0) break;
        for (const Arc& arc : graph.predecessors(task)) {
            const Placement& from = builder_.placement(arc.task);
            const double delay = graph.transfer_time(arc, from.processor, own.processor);
            if (from.end + delay < own.start || from.start >= own.start) continue;
            task = arc.task;
            found = true;
            break;
        }
        if (found) continue;
        const TaskId before = builder_.task_ending_at(own.processor, own.start);
        if (before == task || builder_.placement(before).start >= own.start) break;
        task = before;
        found = true;
    }
}

bool LocalSearch::change(const TaskGraph& graph) {
    const bool from_chain = random_below(4) != 0;
    const TaskId task = from_chain ? chain_[random_below(static_cast<std::uint32_t>(chain_.size()))]
                                   : random_below(graph.task_count());
    moved_.clear();
    from_ = to_ = position_[task];
    switch (random_below(4)) {
        case 0:
            return change_position(graph, task);
        case 1:
            return change_group(graph, task);
        default:
            return change_processor(graph, task, random_below(graph.processor_count()));
    }
}

bool LocalSearch::change_processor(const TaskGraph& graph, TaskId task, ProcessorId p) {
    if (processor_[task] == p || !graph.can_run(task, p)) return false;
    moved_.push_back({task, processor_[task]});
    processor_[task] = p;
    return true;
}

// Together with its neighbours in the graph, each with even chances: where communication is dear, a
// task alone had better stay where they are.
bool LocalSearch::change_group(const TaskGraph& graph, TaskId task) {
    const ProcessorId p = random_below(graph.processor_count());
    change_processor(graph, task, p);
    for (const Arc& arc : graph.predecessors(task)) {
        if (random_below(2) == 0) change_processor(graph, arc.task, p);
    }
    for (const Arc& arc : graph.successors(task)) {
        if (random_below(2) == 0) change_processor(graph, arc.task, p);
    }
    return !moved_.empty();
}

// Anywhere between its last predecessor and its first successor.
bool LocalSearch::change_position(const TaskGraph& graph, TaskId task) {
    std::uint32_t first = 0;
    std::uint32_t last = graph.task_count() - 1;
    for (const Arc& arc : graph.predecessors(task)) {
        first = std::max(first, position_[arc.task] + 1);
    }
    for (const Arc& arc : graph.successors(task)) last = std::min(last, position_[arc.task] - 1);
    if (first >= last) return false;
    std::uint32_t to = first + random_below(last - first);
    if (to >= position_[task]) ++to;
    to_ = to;
    move_task(from_, to_);
    return true;
}

void LocalSearch::move_task(std::uint32_t from, std::uint32_t to) {
    const auto begin = order_.begin();
    if (from < to) {
        std::rotate(begin + from, begin + from + 1, begin + to + 1);
    } else {
        std::rotate(begin + to, begin + from, begin + from + 1);
    }
    for (std::uint32_t i = std::min(from, to); i <= std::max(from, to); ++i) {
        position_[order_[i]] = i;
    }
}

void LocalSearch::undo() {
    for (const Move& move : moved_) processor_[move.task] = move.from;
    if (from_ != to_) move_task(to_, from_);
}

// The makespan, or anything above `limit` as soon as that is certain.
double LocalSearch::evaluate(const TaskGraph& graph, double limit) {
    builder_.begin(graph);
    for (const TaskId t : order_) {
        builder_.place_on(t, processor_[t]);
        const double at_least = builder_.placement(t).end + tail_[t];
        if (at_least > limit * (1.0 + 1e-12)) return at_least;
    }
    return builder_.makespan();
}

// xorshift64*: the same everywhere, unlike the distributions of <random>.
std::uint32_t LocalSearch::random_below(std::uint32_t limit) {
    random_ ^= random_ >> 12;
    random_ ^= random_ << 25;
    random_ ^= random_ >> 27;
    const std::uint64_t high = (random_ * 0x2545f4914f6cdd1du) >> 32;
    return static_cast<std::uint32_t>((high * limit) >> 32);
}

}  // namespace weft::scheduler
