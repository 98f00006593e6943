#pragma once

#include <string>
#include <vector>

#include "simulation/scene/scene.h"

namespace weft {

/// A body whose shape is a file.
struct BodyMesh {
    std::string body;  ///< "cloth.shirt"
    std::string path;
};

/// In the scene's order.
std::vector<BodyMesh> mesh_files(const Scene& scene);

/// Hash of a file's bytes (word_hash.h: its bytes, four to a word, then its length). Throws
/// UserError if it cannot be read.
std::string file_hash(const std::string& path);

}  // namespace weft
