#include "scheduler/optimal.h"

#include <algorithm>

namespace weft::scheduler {
namespace {

// A schedule must be shorter by more than rounding to count as better.
constexpr double kImprovement = 1.0 - 1e-12;
constexpr TaskId kMaxTasks = 200;
constexpr std::uint64_t kWorkPerTimeCheck = 100'000;  // of about a nanosecond each
constexpr std::uint32_t kFirstEvaluations = 5000;     // for the portfolio

}  // namespace

void Optimal::schedule(const TaskGraph& graph, Plan& plan) {
    using namespace std::chrono;
    nodes_ = 0;
    stopped_ = false;
    if (limit_.seconds > 0.0) {
        deadline_ = steady_clock::now() +
                    duration_cast<steady_clock::duration>(duration<double>(limit_.seconds));
    }
    portfolio_.set_budget({.evaluations = kFirstEvaluations, .seconds = 0.25 * limit_.seconds});
    portfolio_.schedule(graph, plan);
    plan.gave_up = !plan.proven_optimal && graph.task_count() > kMaxTasks;
    if (!plan.proven_optimal && !plan.gave_up) {
        prepare(graph);
        best_ = plan.makespan;
        best_sequence_.clear();
        search(0);
        if (!best_sequence_.empty()) write_best(plan);
        plan.proven_optimal = !stopped_;
        plan.gave_up = stopped_;
    }
    plan.algorithm = name();
}

void Optimal::prepare(const TaskGraph& graph) {
    graph_ = &graph;
    const TaskId n = graph.task_count();
    find_twins();
    bounds_.path(graph);
    tail_ = bounds_.tails();
    bounds_.area(graph);
    weight_.assign(bounds_.area_weights().begin(), bounds_.area_weights().end());
    least_area_.assign(n, kCannotRun);
    area_left_ = 0.0;
    missing_.resize(n);
    for (TaskId t = 0; t < n; ++t) {
        missing_[t] = static_cast<std::uint32_t>(graph.predecessors(t).size());
        for (ProcessorId p = 0; p < graph.processor_count(); ++p) {
            if (!graph.can_run(t, p)) continue;
            least_area_[t] = std::min(least_area_[t], weight_[p] * graph.cost(t, p));
        }
        area_left_ += least_area_[t];
    }
    placements_.assign(n, Placement{});
    placed_.assign(n, false);
    sequence_.clear();
    available_.assign(graph.processor_count(), 0.0);
    tasks_on_.assign(graph.processor_count(), 0);
    earliest_end_.resize(std::size_t{n} * graph.processor_count());
    branches_.resize(n);
    time_check_ = 1 + kWorkPerTimeCheck / (n * graph.processor_count());
}

// Of processors that are exactly alike, unused ones need not be tried more than once.
void Optimal::find_twins() {
    const ProcessorId processors = graph_->processor_count();
    const auto alike = [&](ProcessorId a, ProcessorId b) {
        for (TaskId t = 0; t < graph_->task_count(); ++t) {
            if (graph_->cost(t, a) != graph_->cost(t, b)) return false;
        }
        const auto same_link = [&](ProcessorId from, ProcessorId to, ProcessorId from2,
                                   ProcessorId to2) {
            return graph_->latency(from, to) == graph_->latency(from2, to2) &&
                   graph_->bandwidth(from, to) == graph_->bandwidth(from2, to2);
        };
        for (ProcessorId q = 0; q < processors; ++q) {
            if (q == a || q == b) continue;
            if (!same_link(a, q, b, q) || !same_link(q, a, q, b)) return false;
        }
        return same_link(a, b, b, a);
    };
    twin_.resize(processors);
    for (ProcessorId p = 0; p < processors; ++p) {
        twin_[p] = p;
        for (ProcessorId q = 0; q < p && twin_[p] == p; ++q) {
            if (alike(q, p)) twin_[p] = q;
        }
    }
}

void Optimal::search(std::uint32_t depth) {
    if (depth == graph_->task_count()) {
        keep_best();
        return;
    }
    if (limit_reached() || bound_below() >= best_ * kImprovement) return;
    std::vector<Branch>& branches = branches_[depth];
    collect_branches(branches);
    for (const Branch& branch : branches) {
        if (stopped_) return;
        if (branch.bound >= best_ * kImprovement) continue;
        const double available = available_[branch.processor];
        const double area = area_left_;
        place(branch);
        search(depth + 1);
        unplace(branch, available, area);
    }
}

bool Optimal::limit_reached() {
    ++nodes_;
    const bool late = limit_.seconds > 0.0 && nodes_ % time_check_ == 0 &&
                      std::chrono::steady_clock::now() >= deadline_;
    if (nodes_ > limit_.nodes || late) stopped_ = true;
    return stopped_;
}

double Optimal::last_start() const {
    return sequence_.empty() ? 0.0 : placements_[sequence_.back()].start;
}

// The two bounds of bounds.h for what is left: nothing starts before the last start any more.
double Optimal::bound_below() {
    const ProcessorId processors = graph_->processor_count();
    const double earliest = last_start();
    double area = area_left_;
    for (ProcessorId p = 0; p < processors; ++p) {
        area += weight_[p] * std::max(available_[p], earliest);
    }
    double bound = area * kImprovement;
    for (const TaskId t : graph_->topological_order()) {
        if (placed_[t]) continue;
        double least = kCannotRun;
        for (ProcessorId p = 0; p < processors; ++p) {
            const std::size_t at = std::size_t{t} * processors + p;
            earliest_end_[at] = kCannotRun;
            if (!graph_->can_run(t, p)) continue;
            const double start = std::max({earliest, available_[p], earliest_arrival(t, p)});
            earliest_end_[at] = start + graph_->cost(t, p);
            least = std::min(least, start + tail_[at]);
        }
        bound = std::max(bound, least);
        if (bound >= best_ * kImprovement) break;
    }
    return bound;
}

// When the task's data can be at the processor, wherever the predecessors run that are not placed.
double Optimal::earliest_arrival(TaskId task, ProcessorId p) const {
    const ProcessorId processors = graph_->processor_count();
    double latest = 0.0;
    for (const Arc& arc : graph_->predecessors(task)) {
        double arrival = kCannotRun;
        if (placed_[arc.task]) {
            const Placement& from = placements_[arc.task];
            arrival = from.end + graph_->transfer_time(arc, from.processor, p);
        } else {
            const double* end = earliest_end_.data() + std::size_t{arc.task} * processors;
            for (ProcessorId q = 0; q < processors; ++q) {
                arrival = std::min(arrival, end[q] + graph_->transfer_time(arc, q, p));
            }
        }
        latest = std::max(latest, arrival);
    }
    return latest;
}

void Optimal::collect_branches(std::vector<Branch>& branches) {
    const ProcessorId processors = graph_->processor_count();
    branches.clear();
    // Whatever starts after a ready task could have ended on every processor is in vain: that task
    // would fit before, wherever it goes.
    double in_vain = kCannotRun;
    TaskId waiting = 0;
    for (TaskId t = 0; t < graph_->task_count(); ++t) {
        if (placed_[t] || missing_[t] > 0) continue;
        double latest_end = 0.0;
        for (ProcessorId p = 0; p < processors; ++p) {
            if (!graph_->can_run(t, p)) continue;
            const double start = std::max(available_[p], earliest_arrival(t, p));
            latest_end = std::max(latest_end, std::max(start, last_start()) + graph_->cost(t, p));
            if (start < last_start() || repeats(t, p, start)) continue;
            branches.push_back({start + tail_[std::size_t{t} * processors + p], start, t, p});
        }
        if (latest_end < in_vain) {
            in_vain = latest_end;
            waiting = t;
        }
    }
    std::erase_if(branches, [&](const Branch& branch) {
        return branch.task != waiting && branch.start > in_vain;
    });
    std::sort(branches.begin(), branches.end(), [](const Branch& a, const Branch& b) {
        if (a.start != b.start) return a.start < b.start;
        return a.bound < b.bound;
    });
}

// Whether another order of the same tasks, or the same on a processor just alike, covers the case.
bool Optimal::repeats(TaskId task, ProcessorId p, double start) const {
    if (tasks_on_[p] == 0) {
        for (ProcessorId q = twin_[p]; q < p; ++q) {
            if (twin_[q] == twin_[p] && tasks_on_[q] == 0) return true;
        }
    }
    if (sequence_.empty() || start > last_start()) return false;
    // Two tasks that start together on different processors are placed in the order of their ids,
    // unless the second one needs the first.
    const TaskId last = sequence_.back();
    if (task > last || placements_[last].processor == p) return false;
    const std::span<const Arc> before = graph_->predecessors(task);
    return std::ranges::none_of(before, [&](const Arc& arc) { return arc.task == last; });
}

void Optimal::place(const Branch& branch) {
    const double end = branch.start + graph_->cost(branch.task, branch.processor);
    placements_[branch.task] = {branch.start, end, branch.processor};
    placed_[branch.task] = true;
    available_[branch.processor] = end;
    ++tasks_on_[branch.processor];
    area_left_ = std::max(0.0, area_left_ - least_area_[branch.task]);
    sequence_.push_back(branch.task);
    for (const Arc& arc : graph_->successors(branch.task)) --missing_[arc.task];
}

void Optimal::unplace(const Branch& branch, double available, double area) {
    for (const Arc& arc : graph_->successors(branch.task)) ++missing_[arc.task];
    sequence_.pop_back();
    area_left_ = area;
    available_[branch.processor] = available;
    --tasks_on_[branch.processor];
    placed_[branch.task] = false;
}

void Optimal::keep_best() {
    const double makespan = *std::max_element(available_.begin(), available_.end());
    if (makespan >= best_ * kImprovement) return;
    best_ = makespan;
    best_placements_ = placements_;
    best_sequence_ = sequence_;
}

void Optimal::write_best(Plan& plan) const {
    plan.placements = best_placements_;
    plan.order.clear();
    plan.order_begin.assign(1, 0);
    for (ProcessorId p = 0; p < graph_->processor_count(); ++p) {
        for (const TaskId t : best_sequence_) {
            if (best_placements_[t].processor == p) plan.order.push_back(t);
        }
        plan.order_begin.push_back(static_cast<std::uint32_t>(plan.order.size()));
    }
    plan.makespan = best_;
    plan.found_by = name();
}

}  // namespace weft::scheduler
