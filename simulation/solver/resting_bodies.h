#pragma once

#include <memory>
#include <vector>

#include "simulation/contact/body_pushes.h"
#include "simulation/model/model.h"
#include "simulation/solver/free_bodies.h"
#include "simulation/solver/halo.h"

namespace weft {

/// What obstacles do to vertices in a substep, as far as bodies go by it.
struct ObstaclePushes {
    Buffer<float4>* starts = nullptr;    ///< [vertices] x~ before; null: there are no obstacles
    Buffer<float4>* pressing = nullptr;  ///< [vertices] (kernels/obstacles/contact.h); null: no
                                         ///< body rests
};

/// Free bodies on convex obstacles: to the rounds that move these as wholes, obstacles are contacts
/// like any other (kernels/contact/resting.h). Without [contact], of solids alone: rounds lead no
/// cloth into what bears it then, as nothing presses it.
class RestingBodies {
public:
    /// Null: there are no convex obstacles, or no such bodies. creep: of what sticks, per substep
    /// [m]. model must outlive this.
    static std::unique_ptr<RestingBodies> of(Model& model, const FreeBodies& bodies, double creep);
    RestingBodies(Model& model, const FreeBodies& bodies, double creep);

    /// x~ as rounds see it, and before pushes: [vertices] as see() makes them.
    Buffer<float4>& targets() { return targets_; }
    Buffer<float4>& starts() { return starts_; }
    Launch see(Buffer<float4>& targets, const ObstaclePushes& obstacles);
    /// Behind the contacts of `pushes`. starts: x~ before obstacles push. gradients: as
    /// BodyPushes::Resting's
    std::vector<Launch> collect(BodyPushes& pushes, Buffer<float4>& positions,
                                Buffer<float4>& starts, Buffer<float>* gradients, int body_count);
    /// What both need of vertices [first, last), besides all positions and the true x~.
    void add_collect_accesses(Step::Adding& task, const ObstaclePushes& obstacles, int first,
                              int last);

    /// What stays of slips, where a substep ends.
    Launch keep_slips();
    void add_keep_accesses(Step::Adding& task, int first, int last) {
        task.updates(slips_, first, last);
    }
    /// [vertices] what the next substep goes on with
    Buffer<float4>& slips() { return slips_; }

private:
    Model& model_;
    float creep_, reach_;
    Buffer<float> borne_;     ///< [vertices] see the kernels for all of these
    Buffer<float> solid_;     ///< [vertices]
    Buffer<float> hardness_;  ///< [vertices]
    Buffer<float4> targets_;  ///< [vertices]
    Buffer<float4> starts_;   ///< [vertices]
    Buffer<float4> slips_;    ///< [vertices]
    Halo halo_;
    /// [2 * obstacles * vertices]; null: no obstacle is narrow, or no body solid
    std::unique_ptr<Buffer<float4>> meetings_;
};

}  // namespace weft
