#pragma once

#include <memory>

#include "runtime/planning/regions.h"
#include "simulation/contact/body_pushes.h"
#include "simulation/contact/response.h"
#include "simulation/model/model.h"
#include "simulation/solver/free_bodies.h"

namespace weft {

/// Free solids before the planes that contact puts between surfaces: to the rounds that move them
/// as wholes these are hard, so that what comes fast stops as a whole (kernels/contact/stops.h).
class BodyStops {
public:
    /// Null: there are no planes, or no free solids. model and contact must outlive this.
    static std::unique_ptr<BodyStops> of(const Model& model, const FreeBodies& bodies,
                                         ContactResponse* contact);
    BodyStops(const Model& model, const FreeBodies& bodies, ContactResponse& contact);

    /// Behind the contacts of `pushes`.
    Launch collect(BodyPushes& pushes, Buffer<float4>& positions, Buffer<float4>& targets,
                   int body_count);
    /// What that needs of a region, besides the positions and x~.
    void add_collect_accesses(Step::Adding& task, StripRange strips);

private:
    ContactResponse& contact_;
    Buffer<float> hardness_;  ///< [vertices] see the kernel
};

}  // namespace weft
