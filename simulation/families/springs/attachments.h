#pragma once

#include <array>
#include <span>
#include <vector>

#include "simulation/bodies/body_range.h"
#include "simulation/scene/scene.h"

namespace weft {

/// The pairs of vertices (scene order) that an attachment ties together: each selected vertex of a,
/// and the vertex of b that is nearest to it. Throws UserError for a selection that names nothing,
/// or that has nothing of b within reach.
/// bodies  of the scene, cloths first
/// rest    [vertices] where they are at time 0 [m]
std::vector<std::array<int, 2>> find_ties(const Attachment& attachment, const Scene& scene,
                                          std::span<const BodyRange> bodies,
                                          std::span<const Vec3> rest);

}  // namespace weft
