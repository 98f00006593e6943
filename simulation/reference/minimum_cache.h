#pragma once

#include "simulation/reference/newton.h"

namespace weft {

/// The minimum of the potential, from the user's cache or by Newton's method from x~, and kept
/// there for the next time. The cache's key is a hash of the whole problem (state, masses,
/// material, topology, step), so it knows every change of a scene, its meshes and its options; what
/// it finds is checked by its energy and its gradient. progress: as in minimise()
Minimum find_minimum(IncrementalPotential& potential,
                     const std::function<void(const Certificate&)>& progress = {});

}  // namespace weft
