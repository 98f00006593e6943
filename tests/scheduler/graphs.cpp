#include "graphs.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

namespace weft::scheduler::test {

TaskGraph golden(const std::string& name) {
    std::ifstream file(std::string(WEFT_TEST_DATA) + "/" + name + ".json");
    const auto json = nlohmann::json::parse(file);
    TaskGraph graph(static_cast<ProcessorId>(json["processors"].size()));
    std::map<std::string, TaskId> ids;
    for (const auto& task : json["tasks"]) {
        const auto id = task["name"].get<std::string>();
        ids[id] = graph.add_task(task["cost"].get<std::vector<double>>(), {.name = id});
    }
    for (const auto& edge : json["edges"])
        graph.add_edge(ids.at(edge[0]), ids.at(edge[1]), edge[2]);
    graph.seal();
    return graph;
}

TaskGraph random_graph(const RandomGraph& shape, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto number = [&](double low, double high) {
        const double value = low + (high - low) * unit(random);
        return shape.integers ? std::ceil(value) : value;
    };
    TaskGraph graph(shape.processors);
    if (shape.own_links) {
        for (ProcessorId p = 0; p < shape.processors; ++p) {
            for (ProcessorId q = 0; q < shape.processors; ++q) {
                if (p != q) graph.set_link(p, q, number(0.0, 2.0), number(0.5, 2.0));
            }
        }
    }
    std::vector<double> cost(shape.processors);
    for (std::uint32_t t = 0; t < shape.tasks; ++t) {
        const double mean = number(1.0, 19.0);
        const bool zero = unit(random) < shape.zero_share;
        for (double& c : cost) {
            c = number(mean * (1.0 - 0.5 * shape.heterogeneity),
                       mean * (1.0 + 0.5 * shape.heterogeneity));
            if (zero) c = 0.0;
            if (unit(random) < shape.cannot_share) c = kCannotRun;
        }
        if (std::ranges::all_of(cost, [](double c) { return c == kCannotRun; })) cost[0] = mean;
        graph.add_task(cost);
    }
    std::vector<TaskId> id(shape.tasks);
    std::iota(id.begin(), id.end(), TaskId{0});
    if (shape.shuffled) std::shuffle(id.begin(), id.end(), random);
    for (std::uint32_t from = 0; from < shape.tasks; ++from) {
        for (std::uint32_t to = from + 1; to < shape.tasks; ++to) {
            if (unit(random) >= shape.edge_share) continue;
            graph.add_edge(id[from], id[to], number(0.0, 20.0 * shape.ccr));
        }
    }
    graph.seal();
    return graph;
}

namespace {

std::string who(const TaskGraph& graph, TaskId task) { return "task " + graph.label(task) + " "; }

std::string overlap(const TaskGraph& graph, const Plan& plan, ProcessorId p) {
    double free = 0.0;
    for (const TaskId t : plan.tasks_on(p)) {
        const Placement& own = plan.placements[t];
        if (own.processor != p) return who(graph, t) + "is in the order of another processor";
        if (own.start < free) return who(graph, t) + "overlaps with the one before";
        free = own.end;
    }
    return {};
}

/// Whether processors that follow their orders and wait for data would ever wait for each other.
bool gets_stuck(const TaskGraph& graph, const Plan& plan) {
    std::vector<bool> done(graph.task_count(), false);
    std::vector<std::size_t> next(graph.processor_count(), 0);
    std::size_t count = 0;
    for (bool progress = true; progress;) {
        progress = false;
        for (ProcessorId p = 0; p < graph.processor_count(); ++p) {
            const auto tasks = plan.tasks_on(p);
            if (next[p] == tasks.size()) continue;
            const TaskId t = tasks[next[p]];
            const auto before = graph.predecessors(t);
            if (!std::ranges::all_of(before, [&](const Arc& a) { return done[a.task]; })) continue;
            done[t] = progress = true;
            ++next[p];
            ++count;
        }
    }
    return count < graph.task_count();
}

}  // namespace

std::string complaint(const TaskGraph& graph, const Plan& plan) {
    if (plan.placements.size() != graph.task_count()) return "wrong number of placements";
    if (plan.order.size() != graph.task_count()) return "wrong number of tasks in the order";
    std::vector<TaskId> all = plan.order;
    std::sort(all.begin(), all.end());
    for (TaskId t = 0; t < graph.task_count(); ++t) {
        if (all[t] != t) return who(graph, t) + "is not in the order exactly once";
    }
    double latest = 0.0;
    for (TaskId t = 0; t < graph.task_count(); ++t) {
        const Placement& own = plan.placements[t];
        if (own.processor >= graph.processor_count()) return who(graph, t) + "is nowhere";
        if (!graph.can_run(t, own.processor)) return who(graph, t) + "cannot run there";
        if (!(own.start >= 0.0)) return who(graph, t) + "starts before 0";
        if (own.end != own.start + graph.cost(t, own.processor)) return who(graph, t) + "is cut";
        latest = std::max(latest, own.end);
        for (const Arc& arc : graph.predecessors(t)) {
            const Placement& from = plan.placements[arc.task];
            const ProcessorId p = from.processor, q = own.processor;
            const double delay =
                p == q ? 0.0 : graph.latency(p, q) + arc.data / graph.bandwidth(p, q);
            if (own.start < from.end + delay)
                return who(graph, t) + "starts before its data arrive";
        }
    }
    if (plan.makespan != latest) return "the makespan is not the latest end";
    for (ProcessorId p = 0; p < graph.processor_count(); ++p) {
        if (const std::string wrong = overlap(graph, plan, p); !wrong.empty()) return wrong;
    }
    if (gets_stuck(graph, plan)) return "the orders of the processors wait for each other";
    return {};
}

}  // namespace weft::scheduler::test
