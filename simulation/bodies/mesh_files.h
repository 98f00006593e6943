#pragma once

#include <string>
#include <vector>

#include "simulation/scene/scene.h"

namespace weft {

/// A file that a body's shape, or its rest shape, comes from.
struct BodyMesh {
    std::string body;  ///< "cloth.shirt", or "cloth.shirt.rest"
    std::string path;
};

/// In the scene's order.
std::vector<BodyMesh> mesh_files(const Scene& scene);

/// The files of an obstacle's frames, by the number that stands in the place of the *; empty: it
/// has none. Throws UserError where no file fits.
std::vector<std::string> frame_files(const MeshObstacle& obstacle);

/// Hash of a file's bytes (runtime/io/word_hash.h: its bytes, four to a word, then its length).
/// Throws UserError if it cannot be read.
std::string file_hash(const std::string& path);

}  // namespace weft
