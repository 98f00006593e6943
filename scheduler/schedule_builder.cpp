#include "scheduler/schedule_builder.h"

#include <algorithm>
#include <limits>

namespace weft::scheduler {

// Exact from the block that holds slot `from` on, where all has changed.
void ScheduleBuilder::Lane::update_gaps(std::size_t from) {
    longest_gap.resize((slots.size() + kBlock - 1) / kBlock);
    for (std::size_t block = from / kBlock; block < longest_gap.size(); ++block) {
        const std::size_t end = std::min(slots.size(), (block + 1) * kBlock);
        double longest = 0.0;
        for (std::size_t i = block * kBlock; i < end; ++i) {
            const double before = i == 0 ? 0.0 : slots[i - 1].end;
            // The search adds where this subtracts: its rounding must not make the gap longer.
            constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
            longest = std::max(longest, slots[i].start - before + kRounding * slots[i].start);
        }
        longest_gap[block] = longest;
    }
}

void ScheduleBuilder::begin(const TaskGraph& graph) {
    graph_ = &graph;
    if (lanes_.size() < graph.processor_count()) lanes_.resize(graph.processor_count());
    for (Lane& lane : lanes_) {
        lane.slots.clear();
        lane.longest_gap.clear();
    }
    placements_.assign(graph.task_count(), Placement{0.0, 0.0, kNotPlaced});
    history_.clear();
}

std::span<const double> ScheduleBuilder::ready_times(TaskId task) {
    const ProcessorId processors = graph_->processor_count();
    ready_.assign(processors, 0.0);
    for (const Arc& arc : graph_->predecessors(task)) {
        const Placement& from = placements_[arc.task];
        if (from.processor == kNotPlaced) continue;
        for (ProcessorId p = 0; p < processors; ++p) {
            const double arrival = from.end + graph_->transfer_time(arc, from.processor, p);
            ready_[p] = std::max(ready_[p], arrival);
        }
    }
    return ready_;
}

ScheduleBuilder::Gap ScheduleBuilder::find_gap(ProcessorId p, double ready, double cost,
                                               double limit) const {
    const std::vector<Slot>& slots = lanes_[p].slots;
    const std::vector<double>& longest_gap = lanes_[p].longest_gap;
    if (slots.empty() || ready >= slots.back().end) return {ready, slots.size()};
    // A gap can only end with the start of a slot that begins late enough for the task to fit.
    const auto first = std::partition_point(
        slots.begin(), slots.end(), [&](const Slot& slot) { return slot.start < ready + cost; });
    std::size_t i = static_cast<std::size_t>(first - slots.begin());
    while (i < slots.size()) {
        if (longest_gap[i / kBlock] < cost) {
            i = (i / kBlock + 1) * kBlock;
            continue;
        }
        const double start = i == 0 ? ready : std::max(ready, slots[i - 1].end);
        // A task without cost goes behind others without cost at the same time: it may need them.
        const bool behind = cost == 0.0 && slots[i].end == start;
        if ((start + cost <= slots[i].start && !behind) || start + cost >= limit) return {start, i};
        ++i;
    }
    return {slots.back().end, slots.size()};
}

void ScheduleBuilder::place(TaskId task, ProcessorId p, Gap gap) {
    const double end = gap.start + graph_->cost(task, p);
    placements_[task] = {gap.start, end, p};
    history_.push_back(task);
    std::vector<Slot>& slots = lanes_[p].slots;
    if (gap.position == slots.size()) {
        slots.push_back({gap.start, end, task});
    } else {
        slots.insert(slots.begin() + static_cast<std::ptrdiff_t>(gap.position),
                     {gap.start, end, task});
    }
    lanes_[p].update_gaps(gap.position);
}

void ScheduleBuilder::remove_last() {
    const TaskId task = history_.back();
    history_.pop_back();
    Lane& lane = lanes_[placements_[task].processor];
    std::vector<Slot>& slots = lane.slots;
    // Most likely it is the last one, and certainly it is near the end.
    auto slot = slots.end() - 1;
    while (slot->task != task) --slot;
    lane.update_gaps(static_cast<std::size_t>(slots.erase(slot) - slots.begin()));
    placements_[task].processor = kNotPlaced;
}

void ScheduleBuilder::place_on(TaskId task, ProcessorId p) {
    place(task, p, find_gap(p, ready_times(task)[p], graph_->cost(task, p)));
}

void ScheduleBuilder::place_earliest(TaskId task) {
    const std::span<const double> ready = ready_times(task);
    double best_end = kCannotRun;
    ProcessorId best = 0;
    Gap best_gap;
    for (ProcessorId p = 0; p < graph_->processor_count(); ++p) {
        const double cost = graph_->cost(task, p);
        if (ready[p] + cost >= best_end) continue;  // also where it cannot run
        const Gap gap = find_gap(p, ready[p], cost, best_end);
        if (gap.start + cost >= best_end) continue;
        best_end = gap.start + cost;
        best = p;
        best_gap = gap;
    }
    place(task, best, best_gap);
}

TaskId ScheduleBuilder::task_ending_at(ProcessorId p, double time) const {
    const std::vector<Slot>& slots = lanes_[p].slots;
    return std::partition_point(slots.begin(), slots.end(),
                                [&](const Slot& slot) { return slot.end < time; })
        ->task;
}

double ScheduleBuilder::makespan() const {
    double latest = 0.0;
    for (const Lane& lane : lanes_) {
        if (!lane.slots.empty()) latest = std::max(latest, lane.slots.back().end);
    }
    return latest;
}

void ScheduleBuilder::finish(Plan& plan, std::string_view algorithm) const {
    plan.placements.assign(placements_.begin(), placements_.end());
    plan.order.clear();
    plan.order_begin.clear();
    plan.order_begin.push_back(0);
    for (ProcessorId p = 0; p < graph_->processor_count(); ++p) {
        for (const Slot& slot : lanes_[p].slots) plan.order.push_back(slot.task);
        plan.order_begin.push_back(static_cast<std::uint32_t>(plan.order.size()));
    }
    plan.makespan = makespan();
    plan.path_bound = plan.area_bound = 0.0;
    plan.algorithm = plan.found_by = algorithm;
    plan.proven_optimal = plan.gave_up = false;
}

}  // namespace weft::scheduler
