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

/// Throws UserError that names the place in the scene, where a mesh or its rest shape is not there.
void check_there(const MeshFile& file);

/// Hash of a file's bytes (runtime/io/word_hash.h: its bytes, four to a word, then its length).
/// Throws UserError if it cannot be read.
std::string file_hash(const std::string& path);

}  // namespace weft
