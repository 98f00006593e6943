#pragma once

#include <string>
#include <vector>

#include "simulation/topology/stencils.h"
#include "simulation/topology/strips.h"

namespace weft::test {

struct TopologyMesh {
    std::string name;
    int vertex_count = 0;
    std::vector<Stencils> kinds;
};

using Triangles = std::vector<int>;

/// width x height vertices, row by row, every cell cut along the same diagonal.
Triangles grid_triangles(int width, int height);
/// A hub, and `rings` rings of `around` vertices.
Triangles disc_triangles(int rings, int around);

/// Springs and hinges of a triangle mesh.
TopologyMesh cloth(std::string name, int vertex_count, const Triangles& triangles);
/// The same mesh with all vertices renumbered at random.
TopologyMesh shuffled_cloth(std::string name, int vertex_count, Triangles triangles, unsigned seed);
/// Springs in a row.
TopologyMesh chain(int vertex_count);
/// A block of cubes, five tetrahedra each.
TopologyMesh tetrahedra_block(int x, int y, int z);

/// The mesh's elements, in the strips' order of vertices.
std::vector<Stencils> in_new_vertices(const TopologyMesh& mesh, const Strips& strips);

/// One of each shape that has ever been awkward.
std::vector<TopologyMesh> all_meshes();

}  // namespace weft::test
