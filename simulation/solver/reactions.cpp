#include "simulation/solver/reactions.h"

#include <algorithm>

#include "kernels/bodies/reactions.h"

namespace weft {

Reactions::Reactions(Model& model, const FreeBodies& bodies, const Setting& setting, int kind)
    : model_(model),
      setting_(setting),
      halo_(model),
      borne_("reactions.borne", model.positions->count()),
      seams_{kinds().front(), kind, {}},
      strips_{kinds().front(), kind, {}} {
    for (int r = 0; r < bodies.run_count(); ++r) {
        const FreeBodies::Run& run = bodies.run(r);
        if (!run.is_solid) continue;
        std::fill(borne_.data() + run.begin, borne_.data() + run.end, 1.0f);
    }
    Buffer<float>& sums = setting_.derivatives.sums();
    for (const Phase phase : setting_.phases) {
        auto& launches = body(phase).launches;
        launches = setting_.derivatives.gather_gradients(phase, setting_.positions);
        if (setting_.contact != nullptr) {
            launches.push_back(
                setting_.contact->gather_at(phase, setting_.positions, setting_.items, sums));
        }
        launches.push_back(launch(kernels::lead_by_reactions, setting_.items.segments(phase),
                                  setting_.positions, setting_.starts, setting_.targets, borne_,
                                  setting_.items.vertices(), sums, setting_.pressing,
                                  setting_.items.count(),
                                  static_cast<float>(1.0 / (model.h * model.h))));
    }
}

void Reactions::list_bodies(std::vector<const TaskBody*>& bodies) const {
    for (const TaskBody* body : {&seams_, &strips_}) {
        if (!body->launches.empty()) bodies.push_back(body);
    }
}

void Reactions::add(Step& step, const std::vector<Region>& regions, int iteration) {
    for (const Region& region : regions) {
        for_each_part(
            region,
            [&](StripRange seams) {
                if (seams_.launches.empty()) return;
                add_part(step, seams_, seams, region.id, {seams.begin, seams.end + 1}, iteration);
            },
            [&](StripRange strips) {
                add_part(step, strips_, strips, region.id, strips, iteration);
            });
    }
}

/// Contacts reach anywhere.
/// touched  the strips whose vertices have elements there
void Reactions::add_part(Step& step, const TaskBody& body, StripRange strips, RegionId region,
                         StripRange touched, int iteration) {
    const int first = model_.vertices().item(touched.begin);
    const int last = model_.vertices().item(touched.end);
    const auto [halo_begin, halo_end] = halo_.around(first, last);
    auto task = step.add(body, iteration, strips, region);
    task.reads(setting_.starts, first, last)
        .reads(setting_.pressing, first, last)
        .updates(setting_.targets, first, last);
    if (setting_.keeps_blocks) {
        setting_.derivatives.add_hessian_accesses(task, first, last, setting_.contact != nullptr);
    }
    if (setting_.contact == nullptr) {
        task.reads(setting_.positions, halo_begin, halo_end);
        return;
    }
    task.reads(setting_.positions, 0, model_.vertex_count());
    setting_.contact->rows().add_reads(task, touched.begin, touched.end, first, last);
}

}  // namespace weft
