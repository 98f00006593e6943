#include "simulation/solver/resting_bodies.h"

#include <algorithm>

#include "kernels/contact/resting.h"
#include "simulation/contact/stiffness.h"
#include "simulation/families/convert.h"
#include "simulation/model/contact_thickness.h"
#include "simulation/solver/accesses.h"

namespace weft {

namespace {

/// What is farther from obstacles than surfaces that touch each other would be is not near [m].
double reach_of_obstacles(const Model& model) {
    if (model.scene.contact) return model.scene.contact->thickness;
    std::vector<Vec3> rest;
    for (const int vertex : model.strips.rank) {
        rest.push_back(to_vec3((*model.positions)[static_cast<std::size_t>(vertex)]));
    }
    return good_thickness(model.triangles, rest);
}

}  // namespace

std::unique_ptr<RestingBodies> RestingBodies::of(Model& model, const FreeBodies& bodies,
                                                 double creep) {
    if (!model.obstacles || !(model.scene.contact || bodies.has_solids())) return nullptr;
    return std::make_unique<RestingBodies>(model, bodies, creep);
}

RestingBodies::RestingBodies(Model& model, const FreeBodies& bodies, double creep)
    : model_(model),
      creep_(static_cast<float>(creep)),
      reach_(static_cast<float>(reach_of_obstacles(model))),
      borne_("resting.borne", model.positions->count()),
      solid_("resting.solid", model.positions->count()),
      hardness_("resting.hardness", model.positions->count()),
      targets_("resting.targets", model.positions->count()),
      starts_("resting.starts", model.positions->count()),
      slips_("resting.slips", model.positions->count()),
      halo_(model) {
    for (int r = 0; r < bodies.run_count(); ++r) {
        const FreeBodies::Run& run = bodies.run(r);
        const bool is_borne = run.is_solid || model.scene.contact;
        if (is_borne) std::fill(borne_.data() + run.begin, borne_.data() + run.end, 1.0f);
        if (run.is_solid) std::fill(solid_.data() + run.begin, solid_.data() + run.end, 1.0f);
    }
    std::ranges::copy(hard_stiffness(model), hardness_.data());
    if (model.obstacles->narrow() == nullptr || !bodies.has_solids()) return;
    const auto columns = 2 * static_cast<std::size_t>(model.obstacles->count());
    meetings_ =
        std::make_unique<Buffer<float4>>("resting.meetings", columns * model.positions->count());
    NarrowObstacles::clear_meetings(*meetings_);
}

Launch RestingBodies::see(Buffer<float4>& targets, const ObstaclePushes& obstacles) {
    return launch(kernels::see_targets, model_.vertices(), targets, *obstacles.starts,
                  *obstacles.pressing, solid_, targets_, starts_);
}

std::vector<Launch> RestingBodies::collect(BodyPushes& pushes, Buffer<float4>& positions,
                                           Buffer<float4>& starts, Buffer<float>* gradients,
                                           int body_count) {
    std::vector<Launch> launches;
    if (meetings_)
        model_.obstacles->narrow()->add_meeting_launches(
            launches, model_.vertices(), positions, *model_.previous,
            model_.obstacles->placements(), *meetings_, reach_);
    launches.push_back(pushes.collect_resting({positions, *model_.previous, targets_, starts,
                                               slips_, model_.obstacles->placements(), borne_,
                                               solid_, hardness_, meetings_.get(), gradients,
                                               body_count, model_.obstacles->count(), reach_}));
    return launches;
}

void RestingBodies::add_collect_accesses(Step::Adding& task, const ObstaclePushes& obstacles,
                                         int first, int last) {
    task.reads(*obstacles.starts, first, last)
        .reads(*obstacles.pressing, first, last)
        .reads(slips_, first, last)
        .updates(targets_, first, last)
        .updates(starts_, first, last);
    if (!meetings_) {
        task.reads(*model_.previous, first, last);
        return;
    }
    const auto [begin, end] = halo_.around(first, last);
    task.reads(*model_.previous, begin, end);
    add_columns(task, *meetings_, model_.vertex_count(), 2 * model_.obstacles->count(), first, last,
                true);
}

Launch RestingBodies::keep_slips() {
    return launch(kernels::keep_resting_slips, model_.vertices(), *model_.positions,
                  *model_.previous, model_.obstacles->placements(), slips_,
                  model_.obstacles->count(), reach_, creep_, kInstance);
}

}  // namespace weft
