#pragma once

#include <vector>

#include "simulation/scene/scene.h"

namespace weft {

/// `scene.size`: scales the resolutions of all generated cloths by one factor, so that together
/// they have about `vertices` vertices. Cloths read from files stay as they are.
void scale_resolutions(std::vector<Cloth>& cloths, int vertices);

/// Refuses scenes whose generated cloths have more vertices than indices can count. Throws
/// UserError.
void check_vertex_count(const Scene& scene);

}  // namespace weft
