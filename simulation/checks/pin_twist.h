#pragma once

#include <optional>

#include "simulation/mesh/vec3.h"

namespace weft {

struct Scene;

/// A rigid motion like a screw's: about an axis that stays where it is, and along it.
struct Twist {
    Vec3 axis;           ///< unit
    Vec3 center;         ///< [m] on the axis
    double angle = 0.0;  ///< of a substep [rad], > 0
    double slide = 0.0;  ///< along the axis in a substep [m]
};

/// How everything that a scene's pins and mesh obstacles lead is led, if it is all led alike, and
/// turned, in all `substeps` of h [s] from `time` on.
std::optional<Twist> common_twist(const Scene& scene, double time, double h, int substeps);

}  // namespace weft
