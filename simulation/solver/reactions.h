#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/planning/regions.h"
#include "runtime/step.h"
#include "simulation/contact/response.h"
#include "simulation/model/model.h"
#include "simulation/solver/derivatives.h"
#include "simulation/solver/free_bodies.h"
#include "simulation/solver/halo.h"

namespace weft {

/// What obstacles bear of free bodies, once per substep behind its iterations: x~ of what they have
/// pushed is led on until nothing presses it into them (kernels/bodies/reactions.h). A task over
/// the seams, if the solver has vertices there, and one over the strips.
class Reactions {
public:
    /// What the solver has.
    struct Setting {
        Buffer<float4>& positions;  ///< those after the last iteration
        Buffer<float4>& targets;    ///< [vertices] x~
        Buffer<float4>& starts;     ///< [vertices] x~ before obstacles have pushed
        Buffer<float4>& pressing;   ///< [vertices] see kernels/obstacles/contact.h
        VertexItems& items;
        VertexDerivatives& derivatives;  ///< of these; their gradients are overwritten
        std::vector<Phase> phases;       ///< that have items
        bool keeps_blocks;               ///< whether their Hessian blocks outlive tasks
        ContactResponse* contact;        ///< null: none
    };
    /// bodies: of which solids count. (Piles of cloth would be thrown: what presses the lowest one
    /// of them in a few iterations is many times what lies on it.)
    Reactions(Model& model, const FreeBodies& bodies, const Setting& setting, int kind);

    static std::vector<std::string> kinds() { return {"reactions"}; }
    void list_bodies(std::vector<const TaskBody*>& bodies) const;
    void add(Step& step, const std::vector<Region>& regions, int iteration);

private:
    TaskBody& body(Phase phase) { return phase == kSeamPhase ? seams_ : strips_; }
    void add_part(Step& step, const TaskBody& body, StripRange strips, RegionId region,
                  StripRange touched, int iteration);

    Model& model_;
    Setting setting_;
    Halo halo_;
    Buffer<float> borne_;      ///< [vertices] 1: of a body that counts
    TaskBody seams_, strips_;  ///< without launches: no items there
};

}  // namespace weft
