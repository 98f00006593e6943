#pragma once

#include <cstddef>
#include <vector>

#include "simulation/bodies/frame_files.h"

namespace weft {

/// [frames][vertices] of an obstacle whose frames are a dataset (frames, vertices, 3), or the steps
/// of a VTKHDF file, as they stand in it. Throws UserError where there is no such dataset, where it
/// is not known which of several is meant, and for what is no position.
std::vector<std::vector<Vec3>> read_dataset_frames(const MeshObstacle& obstacle,
                                                   const FrameDataset& source,
                                                   std::size_t vertex_count);

}  // namespace weft
