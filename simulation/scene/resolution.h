#pragma once

#include "simulation/scene/scene.h"

namespace weft {

/// `scene.size`: scales the resolutions of all generated cloths and solids by one factor, so that
/// together they have about `vertices` vertices. Those read from files stay as they are. False:
/// there are no others.
bool scale_resolutions(Scene& scene, int vertices);

/// The least resolutions along x and y at which every place of the block's outline has a cell.
std::array<int, 2> least_resolution(const BlockShape& block);

/// Refuses scenes whose generated cloths and solids have more vertices than indices can count.
/// Throws UserError.
void check_vertex_count(const Scene& scene);

}  // namespace weft
