#pragma once

#include <array>

#include "simulation/mesh/vec3.h"

namespace weft {

using Corners = std::array<Vec3, 3>;

/// Between two triangles that do not cross [m].
double distance_of(const Corners& a, const Corners& b);

}  // namespace weft
