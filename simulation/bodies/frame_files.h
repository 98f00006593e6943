#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulation/mesh/triangle_mesh.h"
#include "simulation/scene/scene.h"

namespace weft {

/// A dataset that has all frames of an obstacle: motion.frames = "body.h5:/path/of/dataset".
struct FrameDataset {
    std::string file;
    std::string path;  ///< in the file; empty: the only one of the right shape
};

/// By the file's ending, .h5, .hdf5 or .vtkhdf; it may not be there.
std::optional<FrameDataset> frame_dataset(const MeshObstacle& obstacle);

/// The files of an obstacle's frames (motion.frames): that of its dataset, or those that fit the
/// pattern, by the number that stands in the place of the *; empty: it has none. Throws UserError
/// where no file fits the pattern, and where one that fits has no number there, or the number of
/// another one.
std::vector<std::string> frame_files(const MeshObstacle& obstacle);

/// Warns where their numbers do not go on in equal steps (exporters write every frame, or every so
/// many).
void warn_of_missing_frames(const MeshObstacle& obstacle, Warnings& warnings);

/// Throws UserError with the place in the scene and the value of motion.frames.
[[noreturn]] void refuse_frames(const MeshObstacle& obstacle, const std::string& why);

}  // namespace weft
