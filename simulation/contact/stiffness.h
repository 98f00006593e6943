#pragma once

#include <vector>

#include "simulation/contact/surface.h"
#include "simulation/model/model.h"

namespace weft {

/// What the stiffness of a vertex' contacts is measured by: m / h^2 and a part of how much its
/// elements hold it at rest. So contacts are as stiff as what they hold apart, and scenes with
/// other masses and stiffnesses in one proportion behave alike. Held vertices have more than any
/// other.
struct ContactStiffness {
    std::vector<float> of_all;          ///< [vertices] [N/m]
    std::vector<float> between_sheets;  ///< [vertices] of cloth with cloth [N/m]; or kNoSheet
};

constexpr float kNoSheet = -1.0f;

ContactStiffness contact_stiffness(const Model& model);

/// So much more that to bodies as wholes what presses a vertex with it is hard; of solids, whose
/// corners crush each other when they land, by all that their elements hold [N/m].
std::vector<float> hard_stiffness(const Model& model);

/// The vertices where they are now [m].
std::vector<Vec3> rest_of(const Model& model);
/// All triangles of a model as a surface's.
SurfaceMesh surface_of(const Model& model, double thickness);

}  // namespace weft
