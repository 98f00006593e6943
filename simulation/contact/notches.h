#pragma once

#include <vector>

#include "simulation/contact/surface.h"
#include "simulation/mesh/vec3.h"

namespace weft {

/// By how much a surface's border turns inward at each of its vertices, beyond a straight line
/// [rad]: 0 inside, and where it turns outward; more than any turn where several pieces of surface
/// meet, or an edge has more than two triangles.
/// rest: [model vertices] [m]
std::vector<double> border_notches(const Surface& surface, const std::vector<Vec3>& rest);

/// Whether pieces of surface that hang together leave no room for a slit between them: their
/// border turns inward by no more than a third of what the end of a slit does.
/// turns: of each piece, the sum of its vertices' notches [rad]
bool leave_no_slit(double first, double between, double second);

}  // namespace weft
