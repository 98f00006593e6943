#include "runtime/planning/step_graph.h"

#include <algorithm>
#include <cmath>

#include "runtime/error.h"

namespace weft {

namespace {

constexpr std::size_t kMostGraphs = 64;

Partition partition_of(std::span<const int> sizes) {
    Partition partition;
    int begin = 0;
    for (const int size : sizes) {
        partition.parts.push_back({begin, begin + size});
        begin += size;
    }
    return partition;
}

/// What a maker may get wrong.
void check(const Step& step, std::size_t parts) {
    if (step.tasks().empty()) throw Misuse("make_step() gave a step without tasks");
    if (!step.sealed()) throw Misuse("make_step() gave a step that is not sealed");
    for (const Task& task : step.tasks()) {
        if (task.region >= RegionId{} && index(task.region) < parts) continue;
        throw Misuse("make_step() gave task '" + task.body->name + "' to region " +
                     std::to_string(static_cast<int>(task.region)) + ", and the partition has " +
                     std::to_string(parts) + " parts");
    }
}

}  // namespace

StepGraph::StepGraph(StepMaker& maker, std::span<const int> parts, std::size_t devices)
    : parts_(parts.begin(), parts.end()),
      step_(maker.make_step(partition_of(parts).spread(maker.iterate_count()))) {
    check(step_, parts_.size());
    graph_.clear(static_cast<scheduler::ProcessorId>(devices));
    const std::vector<double> no_cost(devices, 0.0);
    for (const Task& task : step_.tasks()) {
        graph_.add_task(no_cost, {.kind = task.body->kind, .iteration = task.iteration});
    }
    for (const Dependency& d : step_.dependencies()) {
        graph_.add_edge(static_cast<scheduler::TaskId>(d.from),
                        static_cast<scheduler::TaskId>(d.to), d.bytes);
    }
    for (const Dependency& d : step_.carried()) {
        carried_.push_back({static_cast<scheduler::TaskId>(d.from),
                            static_cast<scheduler::TaskId>(d.to), d.bytes});
    }
    std::ranges::stable_sort(carried_, {}, &scheduler::CarriedEdge::to);
}

const scheduler::TaskGraph& StepGraph::price(const TimingModel& timing,
                                             std::span<const unsigned> allowed) {
    const std::size_t devices = graph_.processor_count();
    cost_.resize(devices);
    const auto& tasks = step_.tasks();
    for (std::size_t t = 0; t < tasks.size(); ++t) {
        const unsigned may = allowed[index(tasks[t].region)];
        for (std::size_t d = 0; d < devices; ++d) {
            cost_[d] = (may >> d & 1U) != 0 ? timing.task(tasks[t], static_cast<int>(d))
                                            : scheduler::kCannotRun;
        }
        graph_.set_cost(static_cast<scheduler::TaskId>(t), cost_);
    }
    if (!graph_.sealed() || !links_are_current(timing)) set_links(timing);
    return graph_;
}

void StepGraph::set_links(const TimingModel& timing) {
    const auto devices = graph_.processor_count();
    for (scheduler::ProcessorId p = 0; p < devices; ++p) {
        for (scheduler::ProcessorId q = 0; q < devices; ++q) {
            if (p == q) continue;
            const Link link = timing.link(static_cast<int>(p), static_cast<int>(q));
            graph_.set_link(p, q, link.latency, link.bandwidth);
        }
    }
    graph_.seal();
}

/// Sealing takes longer than planning, so small changes of links wait until they add up.
bool StepGraph::links_are_current(const TimingModel& timing) const {
    const auto differ = [](double used, double known) {
        return std::abs(used - known) > 0.1 * known && used != known;
    };
    const auto devices = graph_.processor_count();
    for (scheduler::ProcessorId p = 0; p < devices; ++p) {
        for (scheduler::ProcessorId q = 0; q < devices; ++q) {
            if (p == q) continue;
            const Link link = timing.link(static_cast<int>(p), static_cast<int>(q));
            if (differ(graph_.latency(p, q), link.latency)) return false;
            if (differ(1.0 / graph_.bandwidth(p, q), 1.0 / link.bandwidth)) return false;
        }
    }
    return true;
}

std::shared_ptr<StepGraph> StepGraphs::of(const std::vector<int>& parts) {
    if (const auto known = known_.find(parts); known != known_.end()) return known->second;
    if (known_.size() >= kMostGraphs) forget_unused();
    return known_.emplace(parts, std::make_shared<StepGraph>(maker_, parts, devices_))
        .first->second;
}

void StepGraphs::forget_unused() {
    std::erase_if(known_, [](const auto& entry) { return entry.second.use_count() == 1; });
}

}  // namespace weft
