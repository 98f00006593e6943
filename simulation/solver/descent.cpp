#include "simulation/solver/descent.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "kernels/descent/free_bodies.h"
#include "kernels/descent/substep.h"
#include "kernels/motion.h"

namespace weft {

DescentSubstep::DescentSubstep(Model& model, int first_kind)
    : model_(model),
      first_kind_(first_kind),
      targets_("targets", static_cast<std::size_t>(model.vertex_count())),
      free_bodies_(FreeBodies::of(model)),
      contact_(ContactResponse::of(model, first_kind + (free_bodies_ ? 1 : 0))) {
    if (contact_ && free_bodies_) {
        const int kind = first_kind + 1 + static_cast<int>(contact_->kinds().size());
        touching_ = std::make_unique<TouchingBodies>(model, *free_bodies_, *contact_, kind);
    }
    if (model.obstacles || touching_)
        pushed_ = std::make_unique<Buffer<float4>>("pushed", targets_.count());
}

void DescentSubstep::list_bodies(std::vector<const TaskBody*>& bodies) const {
    if (!contact_) return;
    for (const TaskBody* body : contact_->bodies()) bodies.push_back(body);
    if (!touching_) return;
    for (const TaskBody* body : touching_->bodies()) bodies.push_back(body);
}

void DescentSubstep::list_kinds(std::vector<std::string>& kinds) const {
    if (free_bodies_) kinds.push_back("momentum");
    if (!contact_) return;
    for (std::string& kind : contact_->kinds()) kinds.push_back(std::move(kind));
    if (!touching_) return;
    for (std::string& kind : touching_->kinds()) kinds.push_back(std::move(kind));
}

std::vector<BufferStorage*> DescentSubstep::state() {
    std::vector<BufferStorage*> buffers{&targets_};
    if (contact_) std::ranges::copy(contact_->state(), std::back_inserter(buffers));
    return buffers;
}

std::vector<RowTable*> DescentSubstep::tables() {
    if (!contact_) return {};
    auto tables = contact_->tables();
    if (touching_) tables.push_back(&touching_->table());
    return tables;
}

std::vector<Launch> DescentSubstep::begin() {
    std::vector<Launch> launches{
        launch(kernels::begin_descent, model_.vertices(), *model_.positions, *model_.previous,
               targets_, *model_.velocities, *model_.gravity, static_cast<float>(model_.h),
               static_cast<float>(model_.h * model_.h), kInstance)};
    if (model_.moving_pins) model_.moving_pins->add_launches(launches, *model_.positions);
    if (contact_) contact_->add_begin(launches, targets_);
    return launches;
}

std::vector<Launch> DescentSubstep::end() {
    std::vector<Launch> launches;
    const auto update = [&](auto kernel) {
        launches.push_back(launch(kernel, model_.vertices(), *model_.positions, *model_.previous,
                                  *model_.velocities, *model_.gravity, static_cast<float>(model_.h),
                                  static_cast<float>(1.0 / model_.h), kInstance));
    };
    if (model_.damped)
        update(kernels::update_damped_velocities);
    else
        update(kernels::update_velocities);
    launches.push_back(
        launch(kernels::keep_deviation, model_.vertices(), *model_.positions, targets_));
    if (free_bodies_) add_shift(launches);
    if (contact_) contact_->add_count(launches);
    return launches;
}

/// Obstacles and contacts have the last word: a shift may lead into them.
void DescentSubstep::add_shift(std::vector<Launch>& launches) {
    if (touching_)
        launches.push_back(touching_->move(model_, targets_));
    else
        for (Launch& shift : free_bodies_->shift(model_, targets_)) launches.push_back(shift);
    if (!pushed_) return;
    launches.push_back(
        launch(kernels::copy_positions, model_.vertices(), *model_.positions, *pushed_));
    if (model_.obstacles) {
        model_.obstacles->add_launches(launches, model_.vertices(), *model_.positions,
                                       *model_.previous);
    }
    if (contact_) contact_->add_truncation(launches, *model_.positions);
    launches.push_back(launch(kernels::push_velocities, model_.vertices(), *model_.positions,
                              *pushed_, *model_.velocities, static_cast<float>(1.0 / model_.h)));
}

std::vector<Launch> DescentSubstep::sum_momentum(Buffer<float4>& positions) {
    return touching_ ? touching_->sum(positions, targets_, kind_of_momentum())
                     : free_bodies_->sum(positions, targets_);
}

void DescentSubstep::add_obstacles(std::vector<Launch>& launches, Buffer<float4>& positions) {
    if (!model_.obstacles) return;
    launches.push_back(launch(kernels::copy_positions, model_.vertices(), positions, *pushed_));
    model_.obstacles->add_launches(launches, model_.vertices(), positions, *model_.previous);
    launches.push_back(
        launch(kernels::push_targets, model_.vertices(), positions, *pushed_, targets_));
}

void DescentSubstep::add_obstacle_accesses(Step::Adding& task, int first, int last) {
    if (!model_.obstacles) return;
    task.updates(targets_, first, last).reads(*model_.previous, first, last);
}

std::pair<int, int> DescentSubstep::vertices(int first_strip, int end_strip) const {
    const auto& begin = model_.strips.begin;
    return {begin[static_cast<std::size_t>(first_strip)],
            begin[static_cast<std::size_t>(end_strip)]};
}

Step::Adding DescentSubstep::add_begin(Step& step, const TaskBody& body, const Region& region) {
    const auto [first, last] = vertices(region.begin, region.end);
    auto task = step.add(body, 0, region.strips(), region.id);
    task.reads(*model_.velocities, first, last)
        .updates(*model_.positions, first, last)
        .updates(*model_.previous, first, last)
        .updates(targets_, first, last);
    if (contact_) contact_->add_begin_accesses(task, first, last);
    return task;
}

void DescentSubstep::add_momentum(Step& step, const TaskBody& body,
                                  const std::vector<Region>& regions, Buffer<float4>& positions,
                                  int iteration) {
    if (!free_bodies_) return;
    if (touching_) return touching_->add_rounds(step, body, regions, positions, iteration);
    for (const Region& region : regions) {
        if (!free_bodies_->reach_into(region.begin, region.end)) continue;
        const auto [first, last] = vertices(region.begin, region.end);
        auto task = step.add(body, iteration, region.strips(), region.id);
        task.reads(targets_, first, last).reads(positions, first, last);
        free_bodies_->add_sum_accesses(task, region.begin, region.end);
    }
}

Step::Adding DescentSubstep::add_end(Step& step, const TaskBody& body, const Region& region,
                                     int iteration) {
    const auto [first, last] = vertices(region.begin, region.end);
    auto task = step.add(body, iteration, region.strips(), region.id);
    task.reads(*model_.previous, first, last)
        .updates(*model_.velocities, first, last)
        .updates(targets_, first, last);
    if (contact_) contact_->add_count_accesses(task, first, last);
    if (!free_bodies_) return task.reads(*model_.positions, first, last);
    if (!touching_) free_bodies_->add_shift_accesses(task);
    if (touching_) touching_->add_motion_accesses(task);
    if (contact_) contact_->add_truncation_accesses(task, first, last);
    return task.updates(*model_.positions, first, last);
}

void DescentSubstep::add_measurements(Step& step, const std::vector<Region>& regions,
                                      int iteration) {
    if (contact_) contact_->energy().add(step, regions, iteration);
}

Halo::Halo(const Model& model) : lowest_(model.strips.order.size()), highest_(lowest_.size()) {
    std::iota(lowest_.begin(), lowest_.end(), 0);
    std::iota(highest_.begin(), highest_.end(), 0);
    for (const Stencils& kind : model.stencils()) {
        for (int e = 0; e < kind.count(); ++e) {
            const auto [low, high] = std::ranges::minmax(kind[e]);
            for (const int v : kind[e]) {
                int& lowest = lowest_[static_cast<std::size_t>(v)];
                int& highest = highest_[static_cast<std::size_t>(v)];
                lowest = std::min(lowest, low);
                highest = std::max(highest, high);
            }
        }
    }
}

std::pair<int, int> Halo::around(int begin, int end) const {
    if (begin >= end) return {begin, end};
    return {*std::min_element(lowest_.begin() + begin, lowest_.begin() + end),
            *std::max_element(highest_.begin() + begin, highest_.begin() + end) + 1};
}

}  // namespace weft
