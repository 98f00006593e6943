#include "simulation/solver/held_bodies.h"

#include <algorithm>
#include <iterator>
#include <optional>

#include "kernels/bodies/free_bodies.h"
#include "kernels/bodies/held_bodies.h"
#include "kernels/bodies/starts.h"
#include "simulation/solver/accesses.h"
#include "simulation/topology/components.h"

namespace weft {

namespace {

/// How hard what obstacles push is held: as in body_momentum.cpp; and, where bodies may touch each
/// other, what others push and touch.
constexpr float kHeld = 50.0f;
constexpr float kFirmly = 1e30f;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

std::unique_ptr<HeldBodies> HeldBodies::of(Model& model, ContactResponse* contact, int kind) {
    const std::vector<HeldBody> bodies = held_bodies(model);
    if (bodies.empty()) return nullptr;
    return std::make_unique<HeldBodies>(model, contact, bodies, kind);
}

HeldBodies::HeldBodies(Model& model, ContactResponse* contact, const std::vector<HeldBody>& bodies,
                       int kind)
    : model_(model), contact_(contact), sums_(model, bodies), body_{"held", kind, {}} {
    if (!contact && !model.obstacles) return;
    number_bodies();
    touched_ = std::make_unique<Buffer<float>>("held.touched", at(sums_.bodies().run_count()));
}

void HeldBodies::number_bodies() {
    const std::size_t count = model_.positions->count();
    seen_ = std::unique_ptr<Seen>(new Seen{{"held.seen", count}, {"held.bodies", count}});
    const std::vector<int> begins = component_begins(model_.vertex_count(), model_.stencils());
    for (std::size_t body = 0; body + 1 < begins.size(); ++body) {
        std::fill(seen_->bodies.data() + begins[body], seen_->bodies.data() + begins[body + 1],
                  static_cast<float>(body));
    }
}

void HeldBodies::look_at(Buffer<float4>& positions, Buffer<float4>& targets,
                         Buffer<float4>* starts) {
    positions_ = &positions;
    targets_ = &targets;
    starts_ = starts;
    body_.launches.clear();
    if (seen_) body_.launches.push_back(see(targets, starts));
    std::ranges::move(sums_.sum(place()), std::back_inserter(body_.launches));
}

HeldSums::Place HeldBodies::place() {
    return {*positions_, seen_ ? seen_->targets : *targets_, starts_, nullptr};
}

Launch HeldBodies::see(Buffer<float4>& targets, Buffer<float4>* starts) {
    const auto rows = contact_ ? std::optional(contact_->rows()) : std::nullopt;
    Buffer<int>& none = sums_.ends();
    return launch(kernels::see_held, model_.vertices(), targets, starts ? *starts : targets,
                  seen_->bodies, rows ? rows->table.rows() : none,
                  rows ? rows->table.counts() : none, rows ? rows->corner0 : none,
                  rows ? rows->corner1 : none, rows ? rows->corner2 : none,
                  rows ? rows->corner3 : none, seen_->targets, contact_ ? 1 : 0);
}

void HeldBodies::add_sums(Step& step, const std::vector<Region>& regions, int iteration) {
    for (const Region& region : regions) {
        if (!sums_.bodies().reach_into(region.begin, region.end)) continue;
        const int first = model_.vertices().item(region.begin);
        const int last = model_.vertices().item(region.end);
        auto task = step.add(body_, iteration, region.strips(), region.id);
        sums_.add_sum_accesses(task, region, place());
        task.reads(*targets_, first, last);
        if (contact_) contact_->rows().add_reads(task, region.begin, region.end, first, last);
    }
}

std::vector<Launch> HeldBodies::move(Buffer<float4>& deviations) {
    FreeBodies& bodies = sums_.bodies();
    const BodyRuns runs = bodies.runs();
    const BodyColumns columns = bodies.columns();
    std::vector<Launch> launches{
        launch(kernels::solve_held, runs.by_strip, sums_.moments().sums(), sums_.pulls(),
               runs.first, runs.counts, sums_.hinges(), sums_.numbers(), sums_.motions(),
               bodies.most_runs(), bodies.run_count(), contact_ ? kFirmly : kHeld),
        launch(kernels::move_held, columns.by_strip, *model_.positions, deviations,
               *model_.velocities, sums_.motions(), columns.members, columns.shares, columns.rows,
               sums_.runs(), static_cast<float>(1.0 / model_.h), bodies.run_count())};
    if (touched_)
        launches.push_back(launch(kernels::keep_touched, runs.by_strip, sums_.moments().sums(),
                                  runs.first, runs.counts, *touched_, bodies.most_runs()));
    return launches;
}

void HeldBodies::add_move_accesses(Step::Adding& task, StripRange strips) {
    sums_.add_reads(task);
    const auto [run, end_run] = sums_.bodies().runs_in(strips.begin, strips.end);
    sums_.add_motion_accesses(task, strips);
    if (touched_) add_columns(task, *touched_, 0, 1, run, end_run, true);
}

}  // namespace weft
