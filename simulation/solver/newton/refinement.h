#pragma once

#include <memory>
#include <span>
#include <vector>

#include "runtime/step.h"
#include "simulation/contact/frozen.h"
#include "simulation/model/model.h"

namespace weft {

/// Newton's method from where another method ended, iteration by iteration: for those who ask how
/// far that was. See newton.h.
class NewtonRefinement {
public:
    virtual ~NewtonRefinement() = default;
    virtual std::vector<const TaskBody*> bodies() const = 0;
    /// Of the contacts: begin() makes room in them.
    virtual std::vector<RowTable*> tables() = 0;

    /// Starts from these positions, and goes to the minimum of E for these x~ and these contacts
    /// (corners in new order). Inertia is that of their inverse masses; vertices of none are held,
    /// whatever the model says.
    virtual void begin(std::span<const float4> positions, std::span<const float4> targets,
                       std::span<const FrozenContact> contacts) = 0;
    /// One iteration with so many conjugate gradients. is_first: after begin()
    virtual Step make_iteration(bool is_first, int gradient_steps) = 0;
    virtual std::span<const float4> positions() const = 0;

    /// Until the next begin(): gives back the memory of all that it and the iterations make anew,
    /// but for the positions. For host memory only.
    virtual void rest() = 0;
};

std::unique_ptr<NewtonRefinement> make_newton_refinement(Model& model);

}  // namespace weft
