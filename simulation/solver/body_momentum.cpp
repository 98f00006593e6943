#include "simulation/solver/body_momentum.h"

#include <algorithm>
#include <iterator>

#include "kernels/bodies/free_bodies.h"
#include "kernels/descent/substep.h"

namespace weft {

namespace {

/// What obstacles bear of cloth is found vertex by vertex, and its elements hold each of them some
/// fifty times as hard as its inertia does. So what such a body lacks as a whole is theirs to make
/// good; xpbd's projections lack nothing.
constexpr float kHeld = 50.0f;

}  // namespace

BodyMomentum::BodyMomentum(Model& model, ContactResponse* contact, Buffer<float>* multipliers,
                           Buffer<float4>& targets, Solves solves, int first_kind)
    : model_(model),
      contact_(contact),
      targets_(targets),
      has_multipliers_(multipliers != nullptr),
      cloth_(solves == Solves::kVertices ? ClothReactions::of(model, contact) : nullptr),
      free_bodies_(FreeBodies::of(model)),
      sums_{"momentum", first_kind, {}} {
    const float held = cloth_ || (contact && !multipliers) ? kHeld : 0.0f;
    if (free_bodies_)
        touching_ =
            TouchingBodies::of(model, *free_bodies_, contact, multipliers, held, first_kind + 1);
    if (free_bodies_ && !touching_) lone_ = std::make_unique<LoneBodies>(*free_bodies_, held);
    if (solves != Solves::kConstraints)
        held_ = HeldBodies::of(model, contact, first_kind + static_cast<int>(kinds().size()));
    if (has_bodies() && (model.obstacles || contact))
        moved_ = std::make_unique<Buffer<float4>>("moved", targets.count());
    if (model.obstacles) starts_ = std::make_unique<Buffer<float4>>("starts", targets.count());
    if (resting()) pressing_ = std::make_unique<Buffer<float4>>("pressing", targets.count());
}

void BodyMomentum::keep_starts(std::vector<Launch>& launches) {
    if (!starts_) return;
    launches.push_back(launch(kernels::copy_positions, model_.vertices(), targets_, *starts_));
    if (pressing_)
        launches.push_back(launch(kernels::start_pressing, model_.vertices(), *pressing_));
}

void BodyMomentum::add_start_accesses(Step::Adding& task, int first, int last) {
    if (starts_) task.updates(*starts_, first, last);
    if (pressing_) task.updates(*pressing_, first, last);
}

Launch BodyMomentum::lead_cloth(VertexItems& items, Phase phase, Buffer<float4>& positions,
                                Buffer<float>& sums) {
    return cloth_->lead(items, phase, positions, {*starts_, targets_}, sums);
}

void BodyMomentum::add_cloth_accesses(Step::Adding& task, int first, int last) {
    if (!cloth_) return;
    task.updates(targets_, first, last).reads(*starts_, first, last);
    cloth_->add_accesses(task, first, last);
}

void BodyMomentum::add_obstacles(std::vector<Launch>& launches, Buffer<float4>& positions) {
    if (!model_.obstacles) return;
    model_.obstacles->add_launches(launches, model_.vertices(), positions, *model_.previous,
                                   {.targets = &targets_, .pressing = pressing_.get()});
}

void BodyMomentum::add_obstacle_accesses(Step::Adding& task, int first, int last) {
    if (!model_.obstacles) return;
    task.updates(targets_, first, last).reads(*model_.previous, first, last);
    if (pressing_) task.updates(*pressing_, first, last);
}

void BodyMomentum::look_at(Buffer<float4>& positions) {
    positions_ = &positions;
    if (touching_)
        sums_.launches =
            touching_->sum(positions, targets_, {starts_.get(), pressing_.get()}, sums_.kind);
    else if (lone_)
        sums_.launches = lone_->sums().sum(model_, positions, targets_, starts_.get());
    if (held_) held_->look_at(positions, targets_, starts_.get());
}

void BodyMomentum::add_sums(Step& step, const std::vector<Region>& regions, int iteration) {
    if (touching_) touching_->add_rounds(step, sums_, regions, *positions_, iteration);
    if (lone_) add_lone_sums(step, regions, iteration);
    if (held_) held_->add_sums(step, regions, iteration);
}

void BodyMomentum::add_lone_sums(Step& step, const std::vector<Region>& regions, int iteration) {
    for (const Region& region : regions) {
        if (!free_bodies_->reach_into(region.begin, region.end)) continue;
        const int first = model_.vertices().item(region.begin);
        const int last = model_.vertices().item(region.end);
        auto task = step.add(sums_, iteration, region.strips(), region.id);
        task.reads(targets_, first, last).reads(*positions_, first, last);
        lone_->sums().add_sum_accesses(task, region, starts_.get());
        lone_->sums().add_origin_reads(task, region, *positions_);
    }
}

void BodyMomentum::add_lead_tasks(Step& step, const TaskBody& lead,
                                  const std::vector<Region>& regions) {
    if (lead.launches.empty()) return;
    touching_->add_first_rounds(step, sums_, regions);
    for (const Region& region : regions) {
        auto task = step.add(lead, 0, region.strips(), region.id);
        add_lead_accesses(task, region.strips());
    }
}

void BodyMomentum::add_lead(std::vector<Launch>& launches, float less) {
    if (!touching_ || !touching_->may_be_led()) return;
    launches.push_back(touching_->lead(less));
    if (!contact_) return;
    contact_->add_truncation(launches, *model_.positions);
    if (!has_multipliers_) contact_->add_start_snapshots(launches, *model_.positions);
}

void BodyMomentum::add_lead_accesses(Step::Adding& task, StripRange strips) {
    touching_->add_motion_accesses(task);
    task.updates(*model_.positions, model_.vertices().item(strips.begin),
                 model_.vertices().item(strips.end));
    if (!contact_) return;
    contact_->add_truncation_accesses(task, strips);
    if (!has_multipliers_) contact_->add_start_snapshot_accesses(task, strips);
}

/// A motion may lead into what pushes.
void BodyMomentum::add_moves(std::vector<Launch>& launches) {
    if (!has_bodies()) return;
    const auto add = [&](std::vector<Launch> moves) {
        std::ranges::move(moves, std::back_inserter(launches));
    };
    if (touching_) launches.push_back(touching_->move(model_, targets_));
    if (lone_) add(lone_->move(model_, targets_));
    if (held_) add(held_->move(targets_));
    if (!moved_) return;
    launches.push_back(
        launch(kernels::copy_positions, model_.vertices(), *model_.positions, *moved_));
    if (model_.obstacles) {
        model_.obstacles->add_launches(launches, model_.vertices(), *model_.positions,
                                       *model_.previous, {.targets = &targets_, .are_last = true});
    }
    if (contact_) contact_->add_truncation(launches, *model_.positions);
    launches.push_back(launch(kernels::push_velocities, model_.vertices(), *model_.positions,
                              *moved_, *model_.velocities, static_cast<float>(1.0 / model_.h)));
    if (resting()) launches.push_back(resting()->keep_slips());
}

void BodyMomentum::add_move_accesses(Step::Adding& task, StripRange strips) {
    if (!has_bodies()) return;
    if (touching_) touching_->add_motion_accesses(task);
    if (lone_) lone_->add_move_accesses(task);
    if (held_) held_->add_move_accesses(task, strips);
    if (contact_) contact_->add_truncation_accesses(task, strips);
    const int first = model_.vertices().item(strips.begin);
    const int last = model_.vertices().item(strips.end);
    task.updates(*model_.positions, first, last).updates(targets_, first, last);
    if (resting()) resting()->add_keep_accesses(task, first, last);
}

void BodyMomentum::list_bodies(std::vector<const TaskBody*>& bodies) const {
    if (free_bodies_) bodies.push_back(&sums_);
    if (touching_) std::ranges::copy(touching_->bodies(), std::back_inserter(bodies));
    if (held_) bodies.push_back(&held_->body());
}

std::vector<std::string> BodyMomentum::kinds() const {
    std::vector<std::string> names;
    if (free_bodies_) names.push_back(sums_.name);
    if (touching_) std::ranges::copy(touching_->kinds(), std::back_inserter(names));
    if (held_) names.push_back(held_->body().name);
    return names;
}

std::vector<RowTable*> BodyMomentum::tables() {
    if (!touching_) return {};
    return {&touching_->table()};
}

}  // namespace weft
