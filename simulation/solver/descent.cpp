#include "simulation/solver/descent.h"

#include <algorithm>
#include <iterator>

#include "kernels/descent/substep.h"
#include "kernels/motion.h"

namespace weft {

DescentSubstep::DescentSubstep(Model& model, BodyMomentum::Solves solves, int first_kind)
    : model_(model),
      targets_("targets", static_cast<std::size_t>(model.vertex_count())),
      contact_(ContactResponse::of(model, first_kind)),
      momentum_(model, contact_.get(), nullptr, targets_, solves,
                first_kind + (contact_ ? static_cast<int>(contact_->kinds().size()) : 0)),
      first_kind_(first_kind) {
    if (contact_) contact_->energy().let_rise(targets_);
}

int DescentSubstep::next_kind() const {
    std::vector<std::string> kinds;
    list_kinds(kinds);
    return first_kind_ + static_cast<int>(kinds.size());
}

void DescentSubstep::lead_tied_parts() { ties_ = TiedParts::of(model_, targets_, next_kind()); }

void DescentSubstep::choose_starts(const StiffStarts::Setting& setting) {
    starts_ = StiffStarts::of(model_, momentum_.held(), setting, next_kind());
}

void DescentSubstep::lead_bodies() {
    lead_ = {"lead", next_kind(), {}};
    momentum_.add_lead(lead_.launches);
}

void DescentSubstep::add_lead(Step& step, const std::vector<Region>& regions) {
    momentum_.add_lead_tasks(step, lead_, regions);
}

void DescentSubstep::add_start(Step& step, const std::vector<Region>& regions) {
    if (starts_) starts_->add(step, regions);
    if (ties_) ties_->add(step);
}

void DescentSubstep::keep_triangles_out(std::vector<Buffer<float4>*> iterates, bool snapshots) {
    narrow_ = NarrowTask::of(
        model_, {std::move(iterates), &targets_, momentum_.pressing(), contact_.get(), snapshots},
        next_kind());
}

void DescentSubstep::look_at_reactions(VertexItems& items, VertexDerivatives& derivatives,
                                       std::vector<Phase> phases, Buffer<float4>& positions,
                                       bool keeps_blocks) {
    if (momentum_.resting() == nullptr || !momentum_.bodies()->has_solids()) return;
    const Reactions::Setting setting{
        positions,   targets_,          *momentum_.starts(), *momentum_.pressing(), items,
        derivatives, std::move(phases), keeps_blocks,        contact_.get()};
    reactions_ = std::make_unique<Reactions>(model_, *momentum_.bodies(), setting, next_kind());
}

void DescentSubstep::add_sums(Step& step, const std::vector<Region>& regions, int iteration) {
    if (reactions_) reactions_->add(step, regions, iteration);
    momentum_.add_sums(step, regions, iteration);
}

void DescentSubstep::add_first_narrow(Step& step, const std::vector<Region>& regions) {
    if (narrow_) narrow_->add_first(step, regions);
}

void DescentSubstep::add_narrow(Step& step, const std::vector<Region>& regions, int iteration,
                                std::size_t iterate) {
    if (narrow_) narrow_->add(step, regions, iteration, iterate);
}

void DescentSubstep::add_last_narrow(Step& step, const std::vector<Region>& regions, int iteration,
                                     std::size_t iterate) {
    if (narrow_) narrow_->add_last(step, regions, iteration, iterate);
}

void DescentSubstep::list_bodies(std::vector<const TaskBody*>& bodies) const {
    if (contact_) std::ranges::copy(contact_->bodies(), std::back_inserter(bodies));
    momentum_.list_bodies(bodies);
    if (ties_) bodies.push_back(&ties_->body());
    if (starts_) std::ranges::copy(starts_->bodies(), std::back_inserter(bodies));
    if (!lead_.launches.empty()) bodies.push_back(&lead_);
    if (narrow_) narrow_->list_bodies(bodies);
    if (reactions_) reactions_->list_bodies(bodies);
}

void DescentSubstep::list_kinds(std::vector<std::string>& kinds) const {
    if (contact_) std::ranges::copy(contact_->kinds(), std::back_inserter(kinds));
    std::ranges::copy(momentum_.kinds(), std::back_inserter(kinds));
    if (ties_) std::ranges::copy(TiedParts::kinds(), std::back_inserter(kinds));
    if (!lead_.launches.empty()) kinds.push_back(lead_.name);
    if (narrow_) std::ranges::copy(narrow_->kinds(), std::back_inserter(kinds));
    if (starts_) std::ranges::copy(StiffStarts::kinds(), std::back_inserter(kinds));
    if (reactions_) std::ranges::copy(Reactions::kinds(), std::back_inserter(kinds));
}

std::vector<BufferStorage*> DescentSubstep::state() {
    std::vector<BufferStorage*> buffers{&targets_};
    if (contact_) std::ranges::copy(contact_->state(), std::back_inserter(buffers));
    if (momentum_.resting()) buffers.push_back(&momentum_.resting()->slips());
    if (starts_ && starts_->state()) buffers.push_back(starts_->state());
    return buffers;
}

std::vector<RowTable*> DescentSubstep::tables() {
    std::vector<RowTable*> tables;
    if (contact_) tables = contact_->tables();
    std::ranges::copy(momentum_.tables(), std::back_inserter(tables));
    return tables;
}

std::vector<Launch> DescentSubstep::begin() {
    std::vector<Launch> launches{
        launch(kernels::begin_descent, model_.vertices(), *model_.positions, *model_.previous,
               targets_, *model_.velocities, *model_.gravity, static_cast<float>(model_.h),
               static_cast<float>(model_.h * model_.h), kInstance)};
    momentum_.keep_starts(launches);
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
    momentum_.add_moves(launches);
    if (contact_) contact_->add_count(launches);
    return launches;
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
    momentum_.add_start_accesses(task, first, last);
    if (contact_) contact_->add_begin_accesses(task, first, last);
    return task;
}

Step::Adding DescentSubstep::add_end(Step& step, const TaskBody& body, const Region& region,
                                     int iteration) {
    const auto [first, last] = vertices(region.begin, region.end);
    auto task = step.add(body, iteration, region.strips(), region.id);
    task.reads(*model_.previous, first, last)
        .updates(*model_.velocities, first, last)
        .updates(targets_, first, last);
    if (contact_) contact_->add_count_accesses(task, first, last);
    momentum_.add_move_accesses(task, region.strips());
    return momentum_.has_bodies() ? task : task.reads(*model_.positions, first, last);
}

void DescentSubstep::add_measurements(Step& step, const std::vector<Region>& regions,
                                      int iteration) {
    if (contact_) contact_->energy().add(step, regions, iteration);
}

}  // namespace weft
