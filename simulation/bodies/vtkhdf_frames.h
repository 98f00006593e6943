#pragma once

#include <cstddef>
#include <vector>

#include "runtime/io/hdf5/handle.h"
#include "simulation/bodies/frame_files.h"

namespace weft {

bool is_vtkhdf(const hdf5::Handle& file);

/// [frames][vertices] of an obstacle that moves as what is in a VTKHDF file with steps, such as a
/// run's frames.vtkhdf. Throws UserError where its steps have other numbers of points than that,
/// and hdf5::Error where they cannot be read.
std::vector<std::vector<Vec3>> read_vtkhdf_frames(const MeshObstacle& obstacle,
                                                  const hdf5::Handle& file,
                                                  std::size_t vertex_count);

}  // namespace weft
