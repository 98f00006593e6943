#include "simulation/mesh/tet_builder.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "runtime/error.h"

namespace weft {

void TetBuilder::add_tetrahedron(const std::array<int, 4>& vertices,
                                 std::span<const std::int64_t> named, const MeshWords& words) {
    auto sorted = vertices;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
        words.fail(fmt::format("degenerate tetrahedron {}: a vertex is named twice",
                               fmt::join(named, " ")));
    }
    mesh_.tetrahedra.push_back(vertices);
}

TetMesh TetBuilder::finish() {
    if (mesh_.positions.empty()) throw UserError(mesh_.source + ": has no vertices");
    if (mesh_.tetrahedra.empty()) {
        throw UserError(mesh_.source +
                        ": has no tetrahedra; a solid needs a volume mesh, not only its surface");
    }
    return std::move(mesh_);
}

}  // namespace weft
