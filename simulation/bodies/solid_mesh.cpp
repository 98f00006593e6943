#include "simulation/bodies/solid_mesh.h"

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/bodies/mesh_files.h"
#include "simulation/bodies/selection.h"
#include "simulation/mesh/generators.h"
#include "simulation/mesh/tet_checks.h"
#include "simulation/mesh/tet_reader.h"
#include "simulation/scene/limits.h"

namespace weft {
namespace {

TetMesh read_checked(const MeshFile& file, Warnings& warnings) {
    check_there(file);
    const std::string& path = file.path;
    TetMesh mesh = read_tetrahedra(path);
    if (mesh.vertex_count() > kMaxVertices) {
        throw UserError(fmt::format("{}: {} vertices are more than the {} that indices can count",
                                    path, mesh.vertex_count(), kMaxVertices));
    }
    drop_duplicates(mesh, warnings);
    turn_inverted(mesh, warnings);
    warn_of_odd_topology(mesh, warnings);
    return mesh;
}

TetMesh block_of(const BlockShape& block) {
    if (block.outline.empty()) return make_block(block.size, block.resolution);
    return make_outlined_block(block.size, block.resolution, block.outline);
}

}  // namespace

TetMesh build_solid_mesh(const Solid& solid, Warnings& warnings) {
    const auto* block = std::get_if<BlockShape>(&solid.shape);
    TetMesh mesh =
        block ? block_of(*block) : read_checked(std::get<MeshFile>(solid.shape), warnings);
    place(mesh.positions, solid.transform);
    check_volumes(mesh);
    return mesh;
}

std::vector<int> pinned_vertices(const Solid& solid, const PinGroup& pins, const TetMesh& mesh) {
    return selected_vertices(pins, solid.shape, mesh.positions, {},
                             fmt::format("pins of solid '{}'", solid.name));
}

}  // namespace weft
