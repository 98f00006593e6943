#pragma once

#include "simulation/model/model.h"

namespace weft {

/// How all contacts rub each other (kernels/contact/friction.h).
struct Rubbing {
    double friction = 0.0;  ///< coefficient
    double creep = 1.0;     ///< [m] > 0
};

/// Without [contact] there is no friction; obstacles have their own.
Rubbing rubbing_of(const Model& model);

}  // namespace weft
