#pragma once

#include <memory>

#include "runtime/step.h"
#include "simulation/contact/response.h"
#include "simulation/families/vertex_items.h"
#include "simulation/model/model.h"

namespace weft {

/// What convex obstacles bear of cloth, in solvers that have a system of each vertex: it is solved
/// with that (kernels/descent/cloth_reactions.h).
class ClothReactions {
public:
    /// Null: there are no obstacles, or no cloth. contact: null: none. Both must outlive this.
    static std::unique_ptr<ClothReactions> of(Model& model, ContactResponse* contact);
    ClothReactions(Model& model, ContactResponse* contact);

    /// What obstacles have done to vertices in the substep so far.
    struct Pushes {
        Buffer<float4>&starts, &targets;  ///< [vertices] x~ before and with all pushes
    };
    /// Leads x~ of the items of a phase by what obstacles bear of them, behind the sums of what
    /// everything else does to them.
    /// sums  [9 * items] see kernels/descent/rows.h
    Launch lead(VertexItems& items, Phase phase, Buffer<float4>& positions, const Pushes& pushes,
                Buffer<float>& sums);
    /// What that needs of vertices [first, last), besides what a solver has and what is pushed.
    void add_accesses(Step::Adding& task, int first, int last);

private:
    Model& model_;
    ContactResponse* contact_;
    Buffer<float> cloth_;  ///< [vertices] 1, or 0
};

}  // namespace weft
