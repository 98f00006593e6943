#pragma once

#include <span>

#include "simulation/model/model.h"

namespace weft {

/// Where a body is held.
struct BodyHinge {
    int from, to;   ///< held vertices, far from each other; the same one if all are in a point
    bool can_turn;  ///< all lie on a line or in a point, and stay so
};

/// held: vertices of one body, one at least
BodyHinge hinge_of(const Model& model, std::span<const int> held);

}  // namespace weft
