#pragma once

#include "simulation/model/model.h"

namespace weft {

/// Says what of a scene is no mistake, but will surprise in the run: bodies that start inside
/// obstacles, obstacles that turn too far in a substep for their sweep to follow, and edges that
/// single precision does not keep.
void warn_of_start(const Model& model, Warnings& warnings);

/// What the vertices that start inside obstacles get by being pushed out in one substep [J].
double energy_inside_obstacles(const Model& model);

}  // namespace weft
