#pragma once

#include <cstddef>
#include <string>

#include "runtime/io/hdf5/handle.h"
#include "simulation/bodies/frame_files.h"

namespace weft {

struct ChosenDataset {
    std::string path;  ///< in its file, for messages
    hdf5::Handle dataset;
    hsize_t frames = 0;  ///< > 0
};

/// The floats (frames, vertices, 3) that an obstacle's frames are: those of source.path, or the
/// only ones in the file. Throws UserError that says what there is instead.
ChosenDataset choose_dataset(const MeshObstacle& obstacle, const FrameDataset& source,
                             const hdf5::Handle& file, std::size_t vertex_count);

constexpr const char* kVtkhdfPoints = "/VTKHDF/Points";

/// The floats (points, 3) of that path, of all frames one behind the other. Likewise.
hdf5::Handle open_points(const MeshObstacle& obstacle, const hdf5::Handle& file,
                         const std::string& path);

}  // namespace weft
