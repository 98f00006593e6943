#include "simulation/solver/narrow_task.h"

#include "simulation/solver/accesses.h"

namespace weft {

namespace {

/// Behind the last iteration. With none, blades of 2 mm cut cloth with cells of 3 cm.
constexpr int kMoreRounds = 5;

}  // namespace

std::unique_ptr<NarrowTask> NarrowTask::of(Model& model, Setting setting, int first_kind) {
    if (!model.obstacles || model.obstacles->narrow() == nullptr) return nullptr;
    return std::unique_ptr<NarrowTask>(new NarrowTask(model, std::move(setting), first_kind));
}

NarrowTask::NarrowTask(Model& model, Setting setting, int first_kind)
    : model_(model), setting_(std::move(setting)), halo_(model) {
    for (Buffer<float4>* positions : setting_.iterates) {
        finds_.push_back({"obstacle-planes", first_kind, find(*positions, false)});
        notes_.push_back({finds_[0].name, first_kind, find(*positions, true)});
        pushes_.push_back({"obstacle-push", first_kind + 1, push(*positions)});
        add_last_word(pushes_.back().launches, *positions);
    }
    first_push_ = {pushes_[0].name, first_kind + 1, push(*setting_.iterates[0])};
}

std::vector<Launch> NarrowTask::find(Buffer<float4>& positions, bool notes) {
    std::vector<Launch> launches;
    model_.obstacles->narrow()->add_launches(launches, model_.vertices(), positions,
                                             *model_.previous, model_.obstacles->placements(),
                                             notes);
    return launches;
}

std::vector<Launch> NarrowTask::push(Buffer<float4>& positions) {
    std::vector<Launch> launches;
    model_.obstacles->add_launches(
        launches, model_.vertices(), positions, *model_.previous,
        {.targets = setting_.targets, .pressing = setting_.pressing, .have_planes = true});
    return launches;
}

void NarrowTask::add_last_word(std::vector<Launch>& launches, Buffer<float4>& positions) {
    if (setting_.contact == nullptr) return;
    setting_.contact->add_truncation(launches, positions);
    if (setting_.snapshots) setting_.contact->add_snapshot(launches, positions);
}

void NarrowTask::list_bodies(std::vector<const TaskBody*>& bodies) const {
    for (const TaskBody& body : finds_) bodies.push_back(&body);
    for (const TaskBody& body : pushes_) bodies.push_back(&body);
    for (const TaskBody& body : notes_) bodies.push_back(&body);
    bodies.push_back(&first_push_);
}

void NarrowTask::add_first(Step& step, const std::vector<Region>& regions) {
    for (const Region& region : regions) add_find(step, finds_[0], region, 0, 0);
    for (const Region& region : regions) add_push(step, first_push_, region, 0, 0);
}

void NarrowTask::add(Step& step, const std::vector<Region>& regions, int iteration,
                     std::size_t iterate) {
    for (const Region& region : regions) {
        add_find(step, finds_[iterate], region, iteration, iterate);
    }
    for (const Region& region : regions) {
        auto task = add_push(step, pushes_[iterate], region, iteration, iterate);
        if (setting_.contact == nullptr) continue;
        setting_.contact->add_truncation_accesses(task, region.strips());
        if (!setting_.snapshots) continue;
        setting_.contact->add_snapshot_accesses(task, iteration, region.begin, region.end);
    }
}

void NarrowTask::add_last(Step& step, const std::vector<Region>& regions, int iteration,
                          std::size_t iterate) {
    for (int round = 0; round < kMoreRounds; ++round) add(step, regions, iteration, iterate);
    for (const Region& region : regions) {
        add_find(step, notes_[iterate], region, iteration, iterate);
    }
}

void NarrowTask::add_find(Step& step, const TaskBody& body, const Region& region, int iteration,
                          std::size_t iterate) {
    NarrowObstacles& narrow = *model_.obstacles->narrow();
    const int first = model_.vertices().item(region.begin);
    const int last = model_.vertices().item(region.end);
    const auto [begin, end] = halo_.around(first, last);
    auto task = step.add(body, iteration, region.strips(), region.id);
    task.reads(*setting_.iterates[iterate], begin, end).reads(*model_.previous, begin, end);
    add_columns(task, narrow.planes(), narrow.vertex_count(), narrow.count(), first, last, true);
    add_columns(task, narrow.depths(), narrow.vertex_count(), narrow.count(), first, last, true);
}

Step::Adding NarrowTask::add_push(Step& step, const TaskBody& body, const Region& region,
                                  int iteration, std::size_t iterate) {
    NarrowObstacles& narrow = *model_.obstacles->narrow();
    const int first = model_.vertices().item(region.begin);
    const int last = model_.vertices().item(region.end);
    auto task = step.add(body, iteration, region.strips(), region.id);
    task.updates(*setting_.iterates[iterate], first, last).reads(*model_.previous, first, last);
    if (setting_.targets != nullptr) task.updates(*setting_.targets, first, last);
    if (setting_.pressing != nullptr) task.updates(*setting_.pressing, first, last);
    add_columns(task, narrow.planes(), narrow.vertex_count(), narrow.count(), first, last, false);
    return task;
}

}  // namespace weft
