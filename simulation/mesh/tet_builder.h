#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "simulation/mesh/mesh_text.h"
#include "simulation/mesh/tet_mesh.h"

namespace weft {

/// What an element of a file is to a reader of tetrahedra.
enum class CellKind { kTetrahedron, kFlat, kOtherSolid };

/// Collects a mesh, and refuses what every format can get wrong.
class TetBuilder {
public:
    explicit TetBuilder(const std::string& path) { mesh_.source = path; }

    void add_vertex(Vec3 position) { mesh_.positions.push_back(position); }
    /// vertices  counted from 0
    /// named     as the file names them, for messages
    void add_tetrahedron(const std::array<int, 4>& vertices, std::span<const std::int64_t> named,
                         const MeshWords& words);
    const TetMesh& mesh() const { return mesh_; }
    TetMesh finish();

private:
    TetMesh mesh_;
};

}  // namespace weft
