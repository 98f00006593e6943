#include "simulation/contact/rubbing.h"

#include <algorithm>
#include <limits>

#include "simulation/model/reach.h"

namespace weft {

namespace {

constexpr double kCreepSpeed = 1e-3;  ///< below which friction sticks [m/s]

/// How far surfaces that stick may creep in a substep [m]; no less than coordinates can tell.
double creep_of(const Model& model) {
    constexpr double kUlp = std::numeric_limits<float>::epsilon();
    return std::max(kCreepSpeed * model.h, 4.0 * kUlp * reach_of(model.positions->span()));
}

}  // namespace

Rubbing rubbing_of(const Model& model) {
    const auto& contact = model.scene.contact;
    return {contact ? contact->friction.value_or(0.0) : 0.0, creep_of(model)};
}

}  // namespace weft
