#include "reference.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace weft::scheduler::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMaxSchedules = 3000;

bool same(double a, double b) { return std::abs(a - b) <= 1e-9 * (1.0 + std::abs(a)); }

/// Plain matrices of everything, so that no code is shared.
struct Problem {
    std::size_t n, processors;
    std::vector<std::vector<double>> cost;
    std::vector<double> mean_cost;
    struct Edge {
        std::size_t from, to;
        double data;
    };
    std::vector<Edge> edges;
    std::vector<std::vector<double>> latency, bandwidth;

    explicit Problem(const TaskGraph& graph)
        : n(graph.task_count()), processors(graph.processor_count()), cost(n), mean_cost(n) {
        for (TaskId t = 0; t < n; ++t) {
            double sum = 0.0, able = 0.0;
            for (ProcessorId p = 0; p < processors; ++p) {
                cost[t].push_back(graph.cost(t, p));
                if (std::isinf(cost[t][p])) continue;
                sum += cost[t][p];
                able += 1.0;
            }
            mean_cost[t] = sum / able;
            for (const Arc& arc : graph.successors(t)) edges.push_back({t, arc.task, arc.data});
        }
        latency.assign(processors, std::vector<double>(processors, 0.0));
        bandwidth = latency;
        for (ProcessorId p = 0; p < processors; ++p) {
            for (ProcessorId q = 0; q < processors; ++q) {
                latency[p][q] = graph.latency(p, q);
                bandwidth[p][q] = graph.bandwidth(p, q);
            }
        }
    }

    double comm(double data, std::size_t p, std::size_t q) const {
        return p == q ? 0.0 : latency[p][q] + data / bandwidth[p][q];
    }
    double mean_comm(double data) const {
        double sum = 0.0;
        for (std::size_t p = 0; p < processors; ++p) {
            for (std::size_t q = 0; q < processors; ++q) sum += comm(data, p, q);
        }
        return processors < 2 ? 0.0 : sum / static_cast<double>(processors * (processors - 1));
    }
    bool depends(std::size_t task, const std::vector<bool>& done) const {
        return std::ranges::any_of(edges,
                                   [&](const Edge& e) { return e.to == task && !done[e.from]; });
    }
    std::vector<double> upward() const {
        std::vector<double> rank(n, -1.0);
        std::function<double(std::size_t)> of = [&](std::size_t t) {
            if (rank[t] >= 0.0) return rank[t];
            double after = 0.0;
            for (const Edge& e : edges) {
                if (e.from == t) after = std::max(after, mean_comm(e.data) + of(e.to));
            }
            return rank[t] = mean_cost[t] + after;
        };
        for (std::size_t t = 0; t < n; ++t) of(t);
        return rank;
    }
    std::vector<double> downward() const {
        std::vector<double> rank(n, -1.0);
        std::function<double(std::size_t)> of = [&](std::size_t t) {
            if (rank[t] >= 0.0) return rank[t];
            double before = 0.0;
            for (const Edge& e : edges) {
                if (e.to != t) continue;
                before = std::max(before, of(e.from) + mean_cost[e.from] + mean_comm(e.data));
            }
            return rank[t] = before;
        };
        for (std::size_t t = 0; t < n; ++t) of(t);
        return rank;
    }
};

struct Placed {
    std::size_t processor = 0;
    double start = 0.0, end = 0.0;
};

/// A partial schedule, copied at every branch.
struct State {
    std::vector<bool> done;
    std::vector<Placed> placed;

    explicit State(const Problem& problem) : done(problem.n, false), placed(problem.n) {}

    double arrival(const Problem& problem, std::size_t task, std::size_t p) const {
        double ready = 0.0;
        for (const auto& e : problem.edges) {
            if (e.to != task || !done[e.from]) continue;
            const Placed& from = placed[e.from];
            ready = std::max(ready, from.end + problem.comm(e.data, from.processor, p));
        }
        return ready;
    }
    /// Earliest start with insertion: at the ready time, or at the end of a placed task.
    double earliest(const Problem& problem, std::size_t task, std::size_t p) const {
        const double ready = arrival(problem, task, p);
        std::vector<double> candidates{ready};
        for (std::size_t t = 0; t < problem.n; ++t) {
            if (done[t] && placed[t].processor == p && placed[t].end > ready) {
                candidates.push_back(placed[t].end);
            }
        }
        std::sort(candidates.begin(), candidates.end());
        for (const double start : candidates) {
            if (fits(problem, p, start, start + problem.cost[task][p])) return start;
        }
        return kInfinity;
    }
    bool fits(const Problem& problem, std::size_t p, double start, double end) const {
        for (std::size_t t = 0; t < problem.n; ++t) {
            if (!done[t] || placed[t].processor != p) continue;
            if (end > placed[t].start && start < placed[t].end) return false;
            // A task without cost does not fit into the middle of another one.
        }
        return true;
    }
    State with(const Problem& problem, std::size_t task, std::size_t p, double start) const {
        State next = *this;
        next.done[task] = true;
        next.placed[task] = {p, start, start + problem.cost[task][p]};
        return next;
    }
    double makespan() const {
        double latest = 0.0;
        for (const Placed& p : placed) latest = std::max(latest, p.end);
        return latest;
    }
    bool complete() const {
        return std::ranges::all_of(done, [](bool d) { return d; });
    }
};

/// Follows all ties of a list algorithm.
class TieWalk {
public:
    /// score(state, task, processor, end): the least one gets the task; infinity bars a processor.
    using Score = std::function<double(std::size_t task, std::size_t processor, double end)>;

    TieWalk(const Problem& problem, std::vector<double> priority, Score score)
        : problem_(problem), priority_(std::move(priority)), score_(std::move(score)) {
        walk(State(problem));
    }
    const std::set<double>& makespans() const { return makespans_; }
    bool gave_up() const { return schedules_ > kMaxSchedules; }

private:
    void walk(const State& state) {
        if (gave_up()) return;
        if (state.complete()) {
            makespans_.insert(state.makespan());
            ++schedules_;
            return;
        }
        double highest = -1.0;
        for (std::size_t t = 0; t < problem_.n; ++t) {
            if (!state.done[t] && !problem_.depends(t, state.done)) {
                highest = std::max(highest, priority_[t]);
            }
        }
        for (std::size_t t = 0; t < problem_.n; ++t) {
            const bool ready = !state.done[t] && !problem_.depends(t, state.done);
            if (ready && same(priority_[t], highest)) place(state, t);
        }
    }
    void place(const State& state, std::size_t task) {
        std::vector<double> start(problem_.processors), score(problem_.processors, kInfinity);
        for (std::size_t p = 0; p < problem_.processors; ++p) {
            if (std::isinf(problem_.cost[task][p])) continue;
            start[p] = state.earliest(problem_, task, p);
            score[p] = score_(task, p, start[p] + problem_.cost[task][p]);
        }
        const double least = *std::min_element(score.begin(), score.end());
        for (std::size_t p = 0; p < problem_.processors; ++p) {
            if (!std::isinf(score[p]) && same(score[p], least)) {
                walk(state.with(problem_, task, p, start[p]));
            }
        }
    }

    const Problem& problem_;
    std::vector<double> priority_;
    Score score_;
    std::set<double> makespans_;
    int schedules_ = 0;
};

/// All critical paths by the published rule: on from an entry task of highest priority to a
/// successor of the same priority over a critical edge.
void critical_paths(const Problem& problem, const std::vector<double>& up,
                    std::vector<std::size_t> path,
                    const std::function<void(const std::vector<std::size_t>&)>& report) {
    double next = -1.0;
    for (const auto& e : problem.edges) {
        if (e.from == path.back()) next = std::max(next, problem.mean_comm(e.data) + up[e.to]);
    }
    if (next < 0.0) return report(path);
    std::set<std::size_t> choices;
    for (const auto& e : problem.edges) {
        const bool critical =
            e.from == path.back() && same(problem.mean_comm(e.data) + up[e.to], next);
        if (critical) choices.insert(e.to);
    }
    for (const std::size_t t : choices) {
        path.push_back(t);
        critical_paths(problem, up, path, report);
        path.pop_back();
    }
}

}  // namespace

std::set<double> heft_makespans(const TaskGraph& graph) {
    const Problem problem(graph);
    const TieWalk walk(problem, problem.upward(),
                       [](std::size_t, std::size_t, double end) { return end; });
    return walk.gave_up() ? std::set<double>{} : walk.makespans();
}

std::set<double> peft_makespans(const TaskGraph& graph) {
    const Problem problem(graph);
    std::vector<std::vector<double>> oct(problem.n);
    std::function<const std::vector<double>&(std::size_t)> of =
        [&](std::size_t t) -> const std::vector<double>& {
        if (!oct[t].empty()) return oct[t];
        std::vector<double> row(problem.processors, 0.0);
        for (const auto& e : problem.edges) {
            if (e.from != t) continue;
            const std::vector<double>& next = of(e.to);
            for (std::size_t p = 0; p < problem.processors; ++p) {
                double least = kInfinity;
                for (std::size_t q = 0; q < problem.processors; ++q) {
                    least = std::min(least, next[q] + problem.cost[e.to][q] +
                                                (p == q ? 0.0 : problem.mean_comm(e.data)));
                }
                row[p] = std::max(row[p], least);
            }
        }
        return oct[t] = row;
    };
    std::vector<double> rank(problem.n);
    for (std::size_t t = 0; t < problem.n; ++t) {
        double sum = 0.0, able = 0.0;
        for (std::size_t p = 0; p < problem.processors; ++p) {
            if (std::isinf(problem.cost[t][p])) continue;
            sum += of(t)[p];
            able += 1.0;
        }
        rank[t] = sum / able;
    }
    const TieWalk walk(problem, rank,
                       [&](std::size_t t, std::size_t p, double end) { return end + oct[t][p]; });
    return walk.gave_up() ? std::set<double>{} : walk.makespans();
}

std::set<double> cpop_makespans(const TaskGraph& graph) {
    const Problem problem(graph);
    const std::vector<double> up = problem.upward();
    std::vector<double> priority = problem.downward();
    for (std::size_t t = 0; t < problem.n; ++t) priority[t] += up[t];
    std::vector<bool> entry(problem.n, true);
    for (const auto& e : problem.edges) entry[e.to] = false;
    double highest = 0.0;
    for (std::size_t t = 0; t < problem.n; ++t) {
        if (entry[t]) highest = std::max(highest, priority[t]);
    }
    std::set<double> all;
    bool gave_up = false;
    const auto follow = [&](const std::vector<std::size_t>& path) {
        std::vector<bool> critical(problem.n, false);
        std::vector<double> sum(problem.processors, 0.0);
        for (const std::size_t t : path) {
            critical[t] = true;
            for (std::size_t p = 0; p < problem.processors; ++p) sum[p] += problem.cost[t][p];
        }
        const double least = *std::min_element(sum.begin(), sum.end());
        for (std::size_t chosen = 0; chosen < problem.processors; ++chosen) {
            if (!std::isinf(least) && !same(sum[chosen], least)) continue;
            const TieWalk walk(problem, priority, [&](std::size_t t, std::size_t p, double end) {
                const bool elsewhere = !std::isinf(least) && critical[t] && p != chosen;
                return elsewhere ? kInfinity : end;
            });
            gave_up = gave_up || walk.gave_up();
            all.insert(walk.makespans().begin(), walk.makespans().end());
            if (std::isinf(least)) break;
        }
    };
    for (std::size_t t = 0; t < problem.n; ++t) {
        if (entry[t] && same(priority[t], highest)) critical_paths(problem, up, {t}, follow);
    }
    return gave_up ? std::set<double>{} : all;
}

namespace {

void try_all(const Problem& problem, const State& state, std::vector<double>& available,
             double& best) {
    if (state.makespan() >= best) return;
    if (state.complete()) {
        best = state.makespan();
        return;
    }
    for (std::size_t t = 0; t < problem.n; ++t) {
        if (state.done[t] || problem.depends(t, state.done)) continue;
        for (std::size_t p = 0; p < problem.processors; ++p) {
            if (std::isinf(problem.cost[t][p])) continue;
            const double start = std::max(available[p], state.arrival(problem, t, p));
            const double before = available[p];
            available[p] = start + problem.cost[t][p];
            try_all(problem, state.with(problem, t, p, start), available, best);
            available[p] = before;
        }
    }
}

}  // namespace

double brute_force_makespan(const TaskGraph& graph) {
    const Problem problem(graph);
    std::vector<double> available(problem.processors, 0.0);
    double best = kInfinity;
    try_all(problem, State(problem), available, best);
    return best;
}

}  // namespace weft::scheduler::test
