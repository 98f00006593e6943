#include "simulation/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <numeric>

#include "runtime/error.h"
#include "runtime/trace/recorded_graph.h"

namespace weft {

namespace {

constexpr int kMostIterates = 31;  // OwnIterates keeps a bit for each

int recorded_iterates(const RunDescription& run) {
    int iterates = 1;
    for (const auto& [name, value] : run.settings) {
        if (name != "iterates") continue;
        std::from_chars(value.data(), value.data() + value.size(), iterates);
    }
    return std::clamp(iterates, 1, kMostIterates);
}

SimulationOptions without_planning(const SimulationOptions& options, const RunDescription& run) {
    SimulationOptions own;
    own.devices = options.devices;
    own.device_options = options.device_options;
    own.calibrate = false;
    own.iterates = recorded_iterates(run);
    own.on_trouble = OnTrouble::kReport;  // the run went on, too
    own.on_crossing = OnCrossing::kWarn;
    return own;
}

UserError does_not_fit(std::uint32_t frame, const std::string& what) {
    return UserError(
        fmt::format("frame {} cannot be replayed: {}; the trace may be of another version of weft",
                    frame, what));
}

/// The recorded plan on so many devices.
scheduler::Plan plan_from(const std::vector<PlanRecord>& tasks, std::size_t devices) {
    scheduler::Plan plan;
    for (const PlanRecord& task : tasks) {
        const auto device = static_cast<scheduler::ProcessorId>(task.device % devices);
        plan.placements.push_back({task.start, task.end, device});
        plan.makespan = std::max(plan.makespan, task.end);
    }
    plan.order_by_start(static_cast<scheduler::ProcessorId>(devices));
    return plan;
}

}  // namespace

Replay::Replay(const Scene& scene, const SimulationOptions& options, const RunDescription& recorded,
               Warnings& warnings)
    : simulation_(scene, without_planning(options, recorded), warnings), recorded_(recorded) {}

void Replay::advance(const FrameRecord& recorded) {
    if (static_cast<int>(recorded.frame) != simulation_.frame()) {
        throw does_not_fit(recorded.frame,
                           fmt::format("frame {} is not in the trace", simulation_.frame()));
    }
    if (const auto substeps = static_cast<int>(recorded.substeps);
        substeps > 0 && substeps != simulation_.model().scene.substeps) {
        simulation_.set_substeps(substeps);
        steps_.clear();
    }
    const std::vector<PlanRecord> tasks = tasks_in_order(recorded_, recorded);
    const Step& step = step_for(recorded);
    check(step, tasks, recorded.frame);
    simulation_.advance_by(step, plan_from(tasks, simulation_.devices().size()));
}

const Step& Replay::step_for(const FrameRecord& recorded) {
    if (!recorded.graph) throw does_not_fit(recorded.frame, "its division was not recorded");
    const auto known = steps_.find(recorded.graph->graph);
    if (known != steps_.end()) return known->second;

    const auto& shares = recorded.graph->strips;
    const Division division{std::vector<int>(shares.begin(), shares.end())};
    const int strips = std::accumulate(division.strips.begin(), division.strips.end(), 0);
    const int here = simulation_.model().strips.count();
    if (strips != here) {
        throw does_not_fit(recorded.frame, fmt::format("it was cut into {} strips, and is cut into "
                                                       "{} here",
                                                       strips, here));
    }
    return steps_.emplace(recorded.graph->graph, simulation_.make_step(division)).first->second;
}

void Replay::check(const Step& step, const std::vector<PlanRecord>& tasks,
                   std::uint32_t frame) const {
    if (tasks.size() != step.tasks().size()) {
        throw does_not_fit(
            frame, fmt::format("it has {} tasks, and {} here", tasks.size(), step.tasks().size()));
    }
    const auto u32 = [](int value) { return static_cast<std::uint32_t>(value); };
    for (std::size_t t = 0; t < tasks.size(); ++t) {
        const Task& own = step.tasks()[t];
        const PlanRecord& task = tasks[t];
        const bool same = u32(own.body->kind) == task.kind &&
                          u32(own.iteration) == task.iteration &&
                          u32(own.first_strip) == task.first_strip &&
                          u32(own.end_strip - own.first_strip) == task.strip_count &&
                          static_cast<std::uint64_t>(own.items) == task.items;
        if (same) continue;
        throw does_not_fit(
            frame, fmt::format("task '{}' is another one here", task_name(recorded_, task)));
    }
}

}  // namespace weft
