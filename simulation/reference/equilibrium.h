#pragma once

#include "simulation/reference/newton.h"

namespace weft {

/// Where a step with friction ends: at the minimum of the E in which friction goes by what presses
/// surfaces together there. That is where all solvers end, since they take those forces from the
/// iteration before; so does this, minimum by minimum, until nothing changes. The potential is left
/// with these forces. Without friction it is minimise().
///
/// Forces that do not settle leave a certificate whose gap says so. Parameters as of minimise()
Minimum find_equilibrium(IncrementalPotential& potential, std::vector<Vec3> start,
                         const std::function<void(const Certificate&)>& progress = {},
                         double enough = 0.0);

}  // namespace weft
