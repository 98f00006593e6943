#pragma once

#include <optional>

#include "simulation/mesh/vec3.h"

namespace weft {

/// The triangles as a weave of two threads.
struct Woven {
    double warp = 0.0;              ///< force per width and strain along the warp [N/m], > 0
    double weft = 0.0;              ///< the same across it [N/m], > 0
    double shear = 0.0;             ///< shear modulus times thickness [N/m], > 0
    std::optional<Vec3> direction;  ///< of the warp, in the world at time 0; absent: of the mesh
};

}  // namespace weft
