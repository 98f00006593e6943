#include "simulation/solver/body_stops.h"

#include <algorithm>

#include "simulation/contact/stiffness.h"

namespace weft {

std::unique_ptr<BodyStops> BodyStops::of(const Model& model, const FreeBodies& bodies,
                                         ContactResponse* contact) {
    if (!contact || !model.scene.contact->planes || !bodies.has_solids()) return nullptr;
    return std::make_unique<BodyStops>(model, bodies, *contact);
}

BodyStops::BodyStops(const Model& model, const FreeBodies& bodies, ContactResponse& contact)
    : contact_(contact), hardness_("stops.hardness", model.positions->count()) {
    const std::vector<float> hard = hard_stiffness(model);
    for (int r = 0; r < bodies.run_count(); ++r) {
        const FreeBodies::Run& run = bodies.run(r);
        if (run.is_solid)
            std::copy(hard.begin() + run.begin, hard.begin() + run.end,
                      hardness_.data() + run.begin);
    }
}

Launch BodyStops::collect(BodyPushes& pushes, Buffer<float4>& positions, Buffer<float4>& targets,
                          int body_count) {
    ContactTruncation& planes = contact_.truncation();
    CommonMotion& motion = contact_.motion();
    return pushes.collect_stops({positions, targets, planes.anchors(), planes.least(),
                                 planes.table(), planes.planes(), hardness_, motion.body_of(),
                                 motion.borne(), body_count, motion.body_count(), planes.slack()});
}

void BodyStops::add_collect_accesses(Step::Adding& task, StripRange strips) {
    contact_.truncation().add_reads(task, strips);
}

}  // namespace weft
