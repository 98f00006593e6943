#include "runtime/planning/plan_log.h"

namespace weft {

namespace {

std::uint32_t u32(int value) { return static_cast<std::uint32_t>(value); }

void add(std::vector<DependencyRecord>& records, const std::vector<Dependency>& dependencies,
         std::uint32_t carried) {
    for (const Dependency& d : dependencies) {
        records.push_back({u32(d.from), u32(d.to), carried, d.bytes});
    }
}

/// Without home, device, place in its queue and times.
PlanRecord task_record(scheduler::TaskId id, const Task& task) {
    PlanRecord record;
    record.task = id;
    record.kind = u32(task.body->kind);
    record.iteration = u32(task.iteration);
    record.first_strip = u32(task.first_strip);
    record.strip_count = u32(task.end_strip - task.first_strip);
    record.items = static_cast<std::uint64_t>(task.items);
    return record;
}

std::vector<PlanRecord> tasks_of(const FramePlan& plan, const TimingModel& timing,
                                 const std::vector<int>& numbers) {
    std::vector<PlanRecord> records;
    const auto number_of = [&](std::size_t device) { return u32(numbers[device]); };
    for (scheduler::ProcessorId d = 0; d < plan.graph.processor_count(); ++d) {
        std::uint32_t order = 0;
        for (const scheduler::TaskId id : plan.plan.tasks_on(d)) {
            const Task& task = plan.step->tasks()[id];
            const std::size_t region = index(task.region);
            PlanRecord& record = records.emplace_back(task_record(id, task));
            record.items = static_cast<std::uint64_t>(timing.items(task));
            record.device = number_of(d);
            record.home = plan.is_placed()
                              ? record.device
                              : number_of(static_cast<std::size_t>(plan.homes[region]));
            record.order = order++;
            record.start = plan.plan.placements[id].start;
            record.end = plan.plan.placements[id].end;
        }
    }
    return records;
}

/// Of one division: the devices' shares; of tasks that are placed one by one: the parts.
std::vector<std::uint32_t> strips_of(const FramePlan& plan, const std::vector<int>& numbers,
                                     std::size_t devices) {
    if (plan.is_placed()) return {plan.parts.begin(), plan.parts.end()};
    std::vector<std::uint32_t> strips(devices, 0);
    const Division division = plan.division();
    for (std::size_t d = 0; d < numbers.size(); ++d) {
        strips[static_cast<std::size_t>(numbers[d])] = u32(division.strips[d]);
    }
    return strips;
}

GraphRecord graph_record(const Step& step, std::vector<std::uint32_t> strips) {
    GraphRecord record;
    record.strips = std::move(strips);
    add(record.dependencies, step.dependencies(), 0);
    add(record.dependencies, step.carried(), 1);
    return record;
}

std::vector<CostRecord> costs_of(const scheduler::CostModel& costs,
                                 const std::vector<int>& numbers) {
    std::vector<CostRecord> records;
    for (std::uint32_t kind = 0; kind < costs.kinds(); ++kind) {
        for (std::uint32_t d = 0; d < costs.devices(); ++d) {
            const auto& fit = costs.fit(kind, d);
            records.push_back(
                {kind, u32(numbers[d]), fit.cost.fixed, fit.cost.per_item, fit.frames});
        }
    }
    return records;
}

std::vector<LinkRecord> links_of(const scheduler::TaskGraph& graph,
                                 const std::vector<int>& numbers) {
    std::vector<LinkRecord> links;
    for (scheduler::ProcessorId p = 0; p < graph.processor_count(); ++p) {
        for (scheduler::ProcessorId q = 0; q < graph.processor_count(); ++q) {
            if (p == q) continue;
            links.push_back(
                {u32(numbers[p]), u32(numbers[q]), graph.latency(p, q), graph.bandwidth(p, q)});
        }
    }
    return links;
}

}  // namespace

void PlanLog::record(const FramePlan& plan, const TimingModel& timing,
                     const std::vector<int>& numbers, FrameRecord& frame) {
    frame.planner = plan.plan.found_by;
    frame.graph = graph_of(plan, numbers);
    frame.plan = tasks_of(plan, timing, numbers);
    frame.costs = costs_of(timing.costs(), numbers);
    frame.links = links_of(plan.graph, numbers);
}

std::shared_ptr<const GraphRecord> PlanLog::graph_of(const FramePlan& plan,
                                                     const std::vector<int>& numbers) {
    std::vector<std::uint32_t> strips = strips_of(plan, numbers, devices_);
    const std::size_t dependencies = plan.step->dependencies().size() + plan.step->carried().size();
    for (const auto& known : graphs_) {
        if (known->strips == strips && known->dependencies.size() == dependencies) return known;
    }
    GraphRecord own = graph_record(*plan.step, std::move(strips));
    own.graph = static_cast<std::uint32_t>(graphs_.size());
    return graphs_.emplace_back(std::make_shared<const GraphRecord>(std::move(own)));
}

FrameRecord record_of(const Step& step, const Division& division) {
    FrameRecord frame;
    frame.graph = std::make_shared<const GraphRecord>(graph_record(
        step, std::vector<std::uint32_t>(division.strips.begin(), division.strips.end())));
    const std::vector<int> homes = division.devices();
    for (const Task& task : step.tasks()) {
        PlanRecord& record = frame.plan.emplace_back(
            task_record(static_cast<scheduler::TaskId>(frame.plan.size()), task));
        record.home = u32(homes[index(task.region)]);
    }
    return frame;
}

}  // namespace weft
