#include "runtime/planning/recorded_plans.h"

#include <algorithm>
#include <numeric>

#include "runtime/error.h"
#include "runtime/trace/recorded_graph.h"

namespace weft {

namespace {

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

bool is_recorded_as(const Task& own, const PlanRecord& task, bool items_vary) {
    const auto u32 = [](int value) { return static_cast<std::uint32_t>(value); };
    return u32(own.body->kind) == task.kind && u32(own.iteration) == task.iteration &&
           u32(own.first_strip) == task.first_strip &&
           u32(own.end_strip - own.first_strip) == task.strip_count &&
           (items_vary ? static_cast<std::uint64_t>(own.items) <= task.items
                       : static_cast<std::uint64_t>(own.items) == task.items);
}

}  // namespace

void refuse_replay(std::uint32_t frame, const std::string& what) {
    throw UserError("frame " + std::to_string(frame) + " cannot be replayed: " + what +
                    "; the trace may be of another version of weft");
}

RecordedPlans::RecordedPlans(RunDescription recorded, int strip_count, MakeStep make_step,
                             ItemsVary items_vary)
    : recorded_(std::move(recorded)),
      strip_count_(strip_count),
      make_step_(std::move(make_step)),
      items_vary_(std::move(items_vary)) {}

RecordedPlans::Planned RecordedPlans::plan_of(const FrameRecord& recorded, std::size_t devices) {
    const std::vector<PlanRecord> tasks = tasks_in_order(recorded_, recorded);
    const Step& step = step_for(recorded);
    check(step, tasks, recorded.frame);
    return {&step, plan_from(tasks, devices)};
}

const Step& RecordedPlans::step_for(const FrameRecord& recorded) {
    if (!recorded.graph) refuse_replay(recorded.frame, "its division was not recorded");
    const auto known = steps_.find(recorded.graph->graph);
    if (known != steps_.end()) return known->second;

    const auto& shares = recorded.graph->strips;
    const Division division{std::vector<int>(shares.begin(), shares.end())};
    const int strips = std::accumulate(division.strips.begin(), division.strips.end(), 0);
    if (strips != strip_count_) {
        refuse_replay(recorded.frame, "it was cut into " + std::to_string(strips) +
                                          " strips, and is cut into " +
                                          std::to_string(strip_count_) + " here");
    }
    return steps_.emplace(recorded.graph->graph, make_step_(division)).first->second;
}

void RecordedPlans::check(const Step& step, const std::vector<PlanRecord>& tasks,
                          std::uint32_t frame) const {
    if (tasks.size() != step.tasks().size()) {
        refuse_replay(frame, "it has " + std::to_string(tasks.size()) + " tasks, and " +
                                 std::to_string(step.tasks().size()) + " here");
    }
    for (std::size_t t = 0; t < tasks.size(); ++t) {
        const Task& own = step.tasks()[t];
        if (is_recorded_as(own, tasks[t], items_vary_(own))) continue;
        refuse_replay(frame, "task '" + task_name(recorded_, tasks[t]) + "' is another one here");
    }
}

}  // namespace weft
