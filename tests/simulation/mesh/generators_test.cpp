#include "simulation/mesh/generators.h"

#include <gtest/gtest.h>

#include "simulation/mesh/mesh_checks.h"

namespace weft {
namespace {

Vec3 area_vector(const TriangleMesh& mesh, int triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    const Vec3 p = mesh.positions[a];
    return 0.5 * cross(mesh.positions[b] - p, mesh.positions[c] - p);
}

TEST(MakeGrid, IsCentredAndFacesUp) {
    const TriangleMesh mesh = make_grid({2.0, 4.0}, {3, 5});
    EXPECT_EQ(mesh.vertex_count(), 15);
    EXPECT_EQ(mesh.triangle_count(), 16);
    EXPECT_EQ(mesh.positions.front(), (Vec3{-1.0, 0.0, -2.0}));
    EXPECT_EQ(mesh.positions.back(), (Vec3{1.0, 0.0, 2.0}));
    EXPECT_EQ(mesh.positions[1], (Vec3{0.0, 0.0, -2.0}));
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        EXPECT_EQ(area_vector(mesh, t), (Vec3{0.0, 0.5, 0.0}));
    }
}

TEST(MakeGrid, CutsEveryCellAlongTheSameDiagonal) {
    const TriangleMesh mesh = make_grid({1.0, 1.0}, {2, 2});
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<int, 3>>{{0, 2, 1}, {1, 2, 3}}));
}

TEST(MakeCylinder, FacesOutwardAndIsClosedAround) {
    const TriangleMesh mesh = make_cylinder({1.0, 2.0}, 3.0, {12, 4});
    EXPECT_EQ(mesh.vertex_count(), 48);
    EXPECT_EQ(mesh.triangle_count(), 12 * 3 * 2);
    EXPECT_EQ(mesh.positions[0], (Vec3{1.0, 1.5, 0.0}));
    EXPECT_EQ(mesh.positions[36], (Vec3{2.0, -1.5, 0.0}));
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        Vec3 outward = mesh.positions[mesh.triangles[t][0]];
        outward.y = 0.0;
        EXPECT_GT(dot(area_vector(mesh, t), outward), 0.0);
    }
    Warnings warnings;
    warn_of_odd_topology(mesh, warnings);
    EXPECT_TRUE(warnings.empty());
}

}  // namespace
}  // namespace weft
