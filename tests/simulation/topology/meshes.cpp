#include "tests/simulation/topology/meshes.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <utility>

#include "simulation/topology/adjacency.h"

namespace weft::test {
namespace {

int random_below(std::mt19937& random, int bound) {
    return static_cast<int>(random() % static_cast<unsigned>(bound));
}

void append_triangles(Triangles& all, const Triangles& more, int first_vertex) {
    for (int v : more) all.push_back(first_vertex + v);
}

/// A grid with a tenth of its triangles gone, some flipped, and some fins on its edges.
TopologyMesh damaged_cloth(int size, unsigned seed) {
    std::mt19937 random(seed);
    const Triangles whole = grid_triangles(size, size);
    Triangles triangles;
    int vertex_count = size * size;
    for (std::size_t t = 0; t < whole.size(); t += 3) {
        std::array<int, 3> corners{whole[t], whole[t + 1], whole[t + 2]};
        const int dice = random_below(random, 40);
        if (dice < 4) continue;
        if (dice < 6) std::swap(corners[0], corners[1]);
        triangles.insert(triangles.end(), corners.begin(), corners.end());
        if (dice == 6) append_triangles(triangles, {corners[0], corners[1], vertex_count++}, 0);
        if (dice == 7) append_triangles(triangles, {corners[0], corners[1], corners[2]}, 0);
    }
    return shuffled_cloth("damaged" + std::to_string(seed), vertex_count, triangles, seed);
}

/// Triangles between any vertices: few levels, no manifold.
TopologyMesh soup(int vertex_count, int triangle_count, unsigned seed) {
    std::mt19937 random(seed);
    Triangles triangles;
    for (int i = 0; i < triangle_count * 3; ++i) {
        triangles.push_back(random_below(random, vertex_count));
    }
    return cloth("soup" + std::to_string(triangle_count), vertex_count, triangles);
}

/// A large grid, many small patches, and vertices that nothing touches in between.
TopologyMesh archipelago(unsigned seed) {
    std::mt19937 random(seed);
    Triangles triangles = grid_triangles(40, 40);
    int vertex_count = 1600;
    for (int i = 0; i < 60; ++i) {
        const int width = 2 + random_below(random, 5), height = 2 + random_below(random, 3);
        append_triangles(triangles, grid_triangles(width, height), vertex_count);
        vertex_count += width * height + random_below(random, 3);
    }
    return shuffled_cloth("archipelago" + std::to_string(seed), vertex_count, triangles, seed);
}

TopologyMesh cloth_beside_solid() {
    TopologyMesh mesh = cloth("cloth beside solid", 900, grid_triangles(30, 30));
    const TopologyMesh solid = tetrahedra_block(12, 3, 3);
    Stencils tetrahedra = solid.kinds[0];
    for (int& v : tetrahedra.vertices) v += mesh.vertex_count;
    mesh.vertex_count += solid.vertex_count;
    mesh.kinds.push_back(tetrahedra);
    return mesh;
}

}  // namespace

Triangles grid_triangles(int width, int height) {
    Triangles triangles;
    for (int y = 0; y + 1 < height; ++y) {
        for (int x = 0; x + 1 < width; ++x) {
            const int a = y * width + x, b = a + 1, c = a + width, d = c + 1;
            append_triangles(triangles, {a, b, d, a, d, c}, 0);
        }
    }
    return triangles;
}

Triangles disc_triangles(int rings, int around) {
    const auto vertex = [&](int ring, int i) {
        return ring == 0 ? 0 : 1 + (ring - 1) * around + i % around;
    };
    Triangles triangles;
    for (int i = 0; i < around; ++i) {
        append_triangles(triangles, {0, vertex(1, i), vertex(1, i + 1)}, 0);
        for (int ring = 1; ring < rings; ++ring) {
            const int a = vertex(ring, i), b = vertex(ring, i + 1);
            const int c = vertex(ring + 1, i), d = vertex(ring + 1, i + 1);
            append_triangles(triangles, {a, c, d, a, d, b}, 0);
        }
    }
    return triangles;
}

TopologyMesh cloth(std::string name, int vertex_count, const Triangles& triangles) {
    Adjacency adjacency = find_adjacency(vertex_count, triangles);
    return {
        std::move(name), vertex_count, {std::move(adjacency.edges), std::move(adjacency.hinges)}};
}

TopologyMesh shuffled_cloth(std::string name, int vertex_count, Triangles triangles,
                            unsigned seed) {
    std::vector<int> new_name(static_cast<std::size_t>(vertex_count));
    std::iota(new_name.begin(), new_name.end(), 0);
    std::shuffle(new_name.begin(), new_name.end(), std::mt19937(seed));
    for (int& v : triangles) v = new_name[v];
    return cloth(std::move(name), vertex_count, triangles);
}

TopologyMesh chain(int vertex_count) {
    Stencils springs;
    for (int v = 0; v + 1 < vertex_count; ++v) {
        springs.vertices.insert(springs.vertices.end(), {v, v + 1});
    }
    return {"chain", vertex_count, {springs}};
}

TopologyMesh tetrahedra_block(int x, int y, int z) {
    Stencils tetrahedra{.arity = 4, .vertices = {}};
    // Corner i of a cube has the offsets given by the bits of i.
    constexpr int kEven[5][4] = {
        {0, 1, 2, 4}, {3, 1, 2, 7}, {5, 1, 4, 7}, {6, 2, 4, 7}, {1, 2, 4, 7}};
    for (int cube = 0; cube < x * y * z; ++cube) {
        const int cx = cube % x, cy = cube / x % y, cz = cube / (x * y);
        const int mirror = (cx + cy + cz) % 2;
        for (const auto& corners : kEven) {
            for (int corner : corners) {
                const int dx = (corner & 1) ^ mirror, dy = corner >> 1 & 1, dz = corner >> 2 & 1;
                tetrahedra.vertices.push_back(((cz + dz) * (y + 1) + cy + dy) * (x + 1) + cx + dx);
            }
        }
    }
    return {"tetrahedra", (x + 1) * (y + 1) * (z + 1), {tetrahedra}};
}

std::vector<Stencils> in_new_vertices(const TopologyMesh& mesh, const Strips& strips) {
    std::vector<Stencils> kinds = mesh.kinds;
    for (Stencils& kind : kinds) {
        for (int& v : kind.vertices) v = strips.rank[static_cast<std::size_t>(v)];
    }
    return kinds;
}

std::vector<TopologyMesh> all_meshes() {
    std::vector<TopologyMesh> meshes{
        {"nothing", 0, {}},
        {"isolated vertices", 300, {Stencils{}}},
        cloth("one triangle", 3, {0, 1, 2}),
        cloth("one triangle and loose vertices", 9, {7, 2, 4}),
        cloth("grid", 900, grid_triangles(30, 30)),
        shuffled_cloth("shuffled grid", 1600, grid_triangles(40, 40), 3),
        cloth("ribbon", 2000, grid_triangles(2, 1000)),
        shuffled_cloth("shuffled ribbon", 1500, grid_triangles(3, 500), 4),
        cloth("disc", 1001, disc_triangles(5, 200)),
        cloth("fan", 301, disc_triangles(1, 300)),
        cloth("cone", 2001, disc_triangles(200, 10)),
        soup(400, 100, 5),
        soup(400, 900, 6),
        archipelago(7),
        archipelago(8),
        chain(1000),
        tetrahedra_block(30, 4, 3),
        cloth_beside_solid(),
    };
    for (unsigned seed = 10; seed < 16; ++seed) meshes.push_back(damaged_cloth(36, seed));
    return meshes;
}

}  // namespace weft::test
