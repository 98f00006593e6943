#pragma once

#include "simulation/reference/newton.h"

namespace weft {

/// The minimum of the potential (with friction: its equilibrium, see equilibrium.h), from the
/// user's cache or by Newton's method from x~, and kept there for the next time. The cache's key is
/// a hash of the whole problem (state, masses, material, topology, step), so it knows every change
/// of a scene, its meshes and its options; what it finds is checked by its energy and its gradient.
/// guess: asked where nothing is kept; where its E is below that of x~, Newton's method starts
/// there. It may be empty, and so may what it gives. progress: as in minimise()
Minimum find_minimum(IncrementalPotential& potential,
                     const std::function<std::vector<Vec3>()>& guess = {},
                     const std::function<void(const Certificate&)>& progress = {});

}  // namespace weft
