#include "runtime/trace/recorded_graph.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

#include "runtime/error.h"

namespace weft {

namespace {

std::string frame_name(const FrameRecord& frame) { return "frame " + std::to_string(frame.frame); }

void set_links(scheduler::TaskGraph& graph, const MachineCosts& costs) {
    for (scheduler::ProcessorId p = 0; p < graph.processor_count(); ++p) {
        for (scheduler::ProcessorId q = 0; q < graph.processor_count(); ++q) {
            if (p != q) graph.set_link(p, q, costs.latency[p][q], costs.bandwidth[p][q]);
        }
    }
}

/// One time per device.
std::vector<double> costs_of(const RunDescription& run, const PlanRecord& task,
                             const MachineCosts& costs, bool pinned) {
    std::vector<double> list(costs.devices.size(), scheduler::kCannotRun);
    const auto& kind = costs.kinds[task.kind];
    for (std::size_t d = 0; d < list.size(); ++d) {
        if (kind[d] && (!pinned || costs.numbers[d] == task.home)) {
            list[d] = (*kind[d])(static_cast<double>(task.items));
        }
    }
    const auto possible = [](double cost) { return cost < scheduler::kCannotRun; };
    if (std::any_of(list.begin(), list.end(), possible)) return list;
    throw UserError("no device can run task '" + task_name(run, task) + "'" +
                    (pinned ? ", which is pinned to device " + std::to_string(task.home) : ""));
}

}  // namespace

MachineCosts::MachineCosts(std::vector<std::string> names, std::size_t kind_count)
    : devices(std::move(names)),
      numbers(devices.size()),
      kinds(kind_count, std::vector<std::optional<scheduler::LinearCost>>(devices.size())),
      latency(devices.size(), std::vector<double>(devices.size(), 0.0)),
      bandwidth(devices.size(),
                std::vector<double>(devices.size(), std::numeric_limits<double>::infinity())) {
    std::iota(numbers.begin(), numbers.end(), 0U);
}

MachineCosts recorded_costs(const RunDescription& run, const FrameRecord& frame) {
    const auto check = [&](bool valid, const char* table) {
        if (valid) return;
        throw UserError(frame_name(frame) + ": its rows of table '" + table +
                        "' are damaged: a kind or device is out of range");
    };
    std::set<std::uint32_t> present;
    for (const CostRecord& cost : frame.costs) {
        check(cost.kind < run.kinds.size() && cost.device < run.devices.size(), "costs");
        present.insert(cost.device);
    }
    std::vector<std::string> names;
    for (const std::uint32_t device : present) names.push_back(short_device_name(run, device));
    MachineCosts costs(std::move(names), run.kinds.size());
    costs.numbers.assign(present.begin(), present.end());
    const auto index = [&](std::uint32_t device) {
        return static_cast<std::size_t>(std::distance(present.begin(), present.find(device)));
    };
    for (const CostRecord& cost : frame.costs) {
        costs.kinds[cost.kind][index(cost.device)] = {cost.fixed, cost.per_item};
    }
    for (const LinkRecord& link : frame.links) {
        check(present.contains(link.from) && present.contains(link.to), "links");
        costs.latency[index(link.from)][index(link.to)] = link.latency;
        costs.bandwidth[index(link.from)][index(link.to)] = link.bandwidth;
    }
    return costs;
}

std::string short_device_name(const RunDescription& run, std::size_t device) {
    const DeviceDescription& d = run.devices.at(device);
    return std::to_string(device) + " " + d.kind + "/" + std::to_string(d.units);
}

std::string task_name(const RunDescription& run, const PlanRecord& task) {
    return std::to_string(task.task) + " " + run.kinds.at(task.kind) + "." +
           std::to_string(task.iteration) + " " + std::to_string(task.first_strip) + "-" +
           std::to_string(task.first_strip + task.strip_count - 1);
}

std::vector<PlanRecord> tasks_in_order(const RunDescription& run, const FrameRecord& frame) {
    std::vector<PlanRecord> tasks = frame.plan;
    std::sort(tasks.begin(), tasks.end(),
              [](const PlanRecord& a, const PlanRecord& b) { return a.task < b.task; });
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        const PlanRecord& task = tasks[i];
        if (task.task == i && task.kind < run.kinds.size() && task.device < run.devices.size()) {
            continue;
        }
        throw UserError(frame_name(frame) + ": row " + std::to_string(i) +
                        " of its plan is damaged: task, kind or device is out of range");
    }
    return tasks;
}

scheduler::TaskGraph rebuild_graph(const RunDescription& run, const FrameRecord& frame,
                                   const MachineCosts& costs, bool pinned) {
    if (!frame.graph) {
        throw UserError(frame_name(frame) +
                        ": the trace holds no dependencies: it was written by an older weft; run "
                        "the scene again");
    }
    scheduler::TaskGraph graph(static_cast<scheduler::ProcessorId>(costs.devices.size()));
    set_links(graph, costs);
    const std::vector<PlanRecord> tasks = tasks_in_order(run, frame);
    for (const PlanRecord& task : tasks) {
        const std::string name = task_name(run, task);
        graph.add_task(costs_of(run, task, costs, pinned),
                       {.kind = static_cast<std::int32_t>(task.kind),
                        .iteration = static_cast<std::int32_t>(task.iteration),
                        .name = name});
    }
    for (const DependencyRecord& d : frame.graph->dependencies) {
        if (d.from >= tasks.size() || d.to >= tasks.size()) {
            throw UserError(frame_name(frame) + ": a dependency names a task that is not there");
        }
        if (d.carried == 0) graph.add_edge(d.from, d.to, d.bytes);
    }
    try {
        graph.seal();
    } catch (const scheduler::GraphError& error) {
        throw UserError(frame_name(frame) + ": " + error.what());
    }
    return graph;
}

}  // namespace weft
