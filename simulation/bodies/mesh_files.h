#pragma once

#include <string>
#include <vector>

#include "simulation/scene/scene.h"

namespace weft {

/// What a body's shape, its rest shape, or its motion comes from.
struct BodyMesh {
    std::string body;   ///< "cloth.shirt", "cloth.shirt.rest", or "obstacle.body.frames"
    std::string named;  ///< path of its file, with that of a dataset, or a sequence's pattern
    std::vector<std::string> files;  ///< that one, or a sequence's in their order
};

/// In the scene's order.
std::vector<BodyMesh> mesh_files(const Scene& scene);

/// Throws UserError that names the place in the scene, where a mesh or its rest shape is not there.
void check_there(const MeshFile& file);

/// Hash of a file's bytes (runtime/io/word_hash.h: its bytes, four to a word, then its length).
/// Throws UserError if it cannot be read.
std::string file_hash(const std::string& path);
/// One for all files of a mesh: that of its file, or of the hashes of a sequence's files. Likewise.
std::string mesh_hash(const BodyMesh& mesh);

}  // namespace weft
