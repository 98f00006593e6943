#include "runtime/planning/work.h"

#include <algorithm>

#include "runtime/error.h"
#include "runtime/planning/regions.h"

namespace weft {

StripWork::StripWork(int strip_count) : strip_count_(strip_count) {
    if (strip_count < 1) {
        throw Misuse("work needs at least one strip, not " + std::to_string(strip_count));
    }
}

void StripWork::check(const Segments& strips, const std::string& stage) const {
    if (strips.strip_count == strip_count_) return;
    throw Misuse("stage '" + stage + "': a table of " + std::to_string(strips.strip_count) +
                 " strips, and the work has " + std::to_string(strip_count_));
}

StripWork::Stage StripWork::add(std::string name, std::vector<Launch> launches) {
    if (launches.empty()) throw Misuse("stage '" + name + "': it has no launch");
    for (const Launch& launch : launches) check(launch.segments, name);
    Description& stage = stages_.emplace_back();
    stage.body.name = std::move(name);
    stage.body.kind = static_cast<int>(stages_.size()) - 1;
    stage.body.launches = std::move(launches);
    return {*this, stages_.size() - 1};
}

StripWork::Stage& StripWork::Stage::reads(BufferStorage& buffer, const Segments& strips,
                                          int reach) {
    Description& stage = work_.stages_[number_];
    work_.check(strips, stage.body.name);
    if (reach < 0) {
        throw Misuse("stage '" + stage.body.name + "': it cannot reach " + std::to_string(reach) +
                     " strips far");
    }
    stage.parts.push_back({.buffer = &buffer, .strips = strips, .reach = reach});
    return *this;
}

StripWork::Stage& StripWork::Stage::reads(BufferStorage& buffer) {
    work_.stages_[number_].parts.push_back({.buffer = &buffer, .whole = true});
    return *this;
}

StripWork::Stage& StripWork::Stage::reads_by_instance(BufferStorage& buffer,
                                                      int elements_per_instance) {
    work_.stages_[number_].parts.push_back(
        {.buffer = &buffer, .per_instance = elements_per_instance, .whole = true});
    return *this;
}

StripWork::Stage& StripWork::Stage::updates(BufferStorage& buffer, const Segments& strips) {
    Description& stage = work_.stages_[number_];
    work_.check(strips, stage.body.name);
    stage.parts.push_back({.buffer = &buffer, .strips = strips, .writes = true});
    return *this;
}

/// Strips of a stage run at the same time, so none may read what another one writes.
void StripWork::check_neighbours(const Description& stage) {
    for (const Part& read : stage.parts) {
        const bool far = !read.writes && (read.reach > 0 || (read.whole && read.per_instance == 0));
        const auto is_same = [&](const Part& p) { return p.writes && p.buffer == read.buffer; };
        if (!far || std::ranges::none_of(stage.parts, is_same)) continue;
        throw Misuse("stage '" + stage.body.name + "' reads other strips of '" +
                     read.buffer->name() +
                     "', which it writes itself: let it write another buffer, and a second stage "
                     "take that back");
    }
}

std::vector<const TaskBody*> StripWork::bodies() const {
    std::vector<const TaskBody*> list;
    for (const Description& stage : stages_) list.push_back(&stage.body);
    return list;
}

std::vector<std::string> StripWork::kinds() const {
    std::vector<std::string> names;
    for (const Description& stage : stages_) names.push_back(stage.body.name);
    return names;
}

int StripWork::largest_reach() const {
    int most = 0;
    for (const Description& stage : stages_) {
        for (const Part& part : stage.parts) most = std::max(most, part.reach);
    }
    return most;
}

void StripWork::add_task(Step& step, const Description& stage, StripRange strips,
                         RegionId region) const {
    if (strips.empty()) return;
    auto task = step.add(stage.body, 0, strips, region);
    for (const Part& part : stage.parts) {
        if (part.per_instance > 0) {
            task.reads_by_instance(*part.buffer, part.per_instance);
        } else if (part.whole) {
            task.reads(*part.buffer, 0, static_cast<int>(part.buffer->count()));
        } else if (part.writes) {
            task.updates(*part.buffer, part.strips);
        } else {
            task.reads(*part.buffer, part.strips, std::max(strips.begin - part.reach, 0),
                       std::min(strips.end + part.reach, strip_count_));
        }
    }
}

/// In each region first the strips that others wait for, which then have the rest of the stage's
/// time to arrive.
Step StripWork::make_step(const Partition& partition) {
    if (stages_.empty()) throw Misuse("the work has no stages: add() some first");
    Step step;
    const int reach = std::max(largest_reach(), 1);
    for (const Description& stage : stages_) {
        check_neighbours(stage);
        for (const Region& region : regions_of(partition)) {
            const int near_end =
                region.cut_before ? std::min(region.begin + reach, region.end) : region.begin;
            const int far_end =
                region.cut_behind ? std::max(region.end - reach, near_end) : region.end;
            add_task(step, stage, {region.begin, near_end}, region.id);
            add_task(step, stage, {far_end, region.end}, region.id);
            add_task(step, stage, {near_end, far_end}, region.id);
        }
    }
    step.seal();
    return step;
}

namespace {

/// So that there is something to choose from: the planner looks for placements where there are two
/// parts of two strips at least.
constexpr int kLeastStrips = 4;

int strips_of(const Task& task) {
    int most = task.end_strip;
    for (const Launch& launch : task.body->launches) {
        most = std::max(most, launch.segments.strip_count);
    }
    return most;
}

}  // namespace

StepWork::StepWork(const Step& step) : tasks_(step.tasks()), limits_(step.instance_limits()) {
    if (tasks_.empty()) throw Misuse("the step has no tasks");
    if (!step.sealed()) throw Misuse("the step is not sealed: call seal() behind its last task");
    strip_count_ = kLeastStrips;
    for (Task& task : tasks_) {
        task.region = {};
        strip_count_ = std::max(strip_count_, strips_of(task));
    }
}

std::vector<const TaskBody*> StepWork::bodies() const {
    std::vector<const TaskBody*> list;
    for (const Task& task : tasks_) {
        if (std::ranges::find(list, task.body) == list.end()) list.push_back(task.body);
    }
    return list;
}

std::vector<std::string> StepWork::kinds() const {
    std::vector<std::string> names;
    for (const TaskBody* body : bodies()) {
        const auto kind = static_cast<std::size_t>(std::max(body->kind, 0));
        if (names.size() <= kind) names.resize(kind + 1);
        names[kind] = body->name;
    }
    return names;
}

Step StepWork::make_step(const Partition&) {
    Step step;
    for (const Task& task : tasks_) step.add(task);
    for (const Step::InstanceLimit& limit : limits_) step.add_instance_limit(limit);
    step.seal();
    return step;
}

}  // namespace weft
