#pragma once

#include <string>
#include <vector>

#include "simulation/mesh/triangle_mesh.h"
#include "simulation/scene/scene.h"

namespace weft {

/// The files of an obstacle's frames (motion.frames), by the number that stands in the place of the
/// *; empty: it has none. Throws UserError where no file fits, and where one that fits has no
/// number there, or the number of another one.
std::vector<std::string> frame_files(const MeshObstacle& obstacle);

/// Warns where their numbers do not go on in equal steps (exporters write every frame, or every so
/// many).
void warn_of_missing_frames(const MeshObstacle& obstacle, Warnings& warnings);

}  // namespace weft
