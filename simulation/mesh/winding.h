#pragma once

#include "simulation/mesh/crossings.h"

namespace weft {

/// How often the triangles [begin, end) of a surface go around a point: 1 inside of a closed body
/// whose triangles face outward, 0 outside (Van Oosterom and Strackee 1983).
double winding_number(const PlainSurface& surface, int begin, int end, Vec3 point);

}  // namespace weft
