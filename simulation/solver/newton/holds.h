#pragma once

#include <memory>

#include "simulation/solver/descent.h"

namespace weft {

/// What holds vertices while newton's system is solved (kernels/newton/holds.h): convex obstacles
/// that solids are pressed into, and contacts that have taken vertices back.
class NewtonHolds {
public:
    /// Null: the model has neither. control: as the kernel's. All must outlive this.
    static std::unique_ptr<NewtonHolds> of(Model& model, DescentSubstep& substep,
                                           Buffer<float>& control);
    NewtonHolds(Model& model, DescentSubstep& substep, Buffer<float>& control);

    /// Finds them, behind the sums. sums: [9 * vertices] of all elements and contacts
    Launch find(Buffer<float>& sums);
    /// What that needs of vertices [first, last), besides the sums, the positions and x~.
    void add_find_accesses(Step::Adding& task, int first, int last);

    Buffer<float4>& holds() { return holds_; }  ///< [vertices] as the kernel's

private:
    Model& model_;
    DescentSubstep& substep_;
    Buffer<float>& control_;
    Buffer<float> solid_;   ///< [vertices] 1, or 0
    Buffer<float4> holds_;  ///< [vertices]
    Buffer<int> none_{"newton.no_contacts", 1};
};

}  // namespace weft
