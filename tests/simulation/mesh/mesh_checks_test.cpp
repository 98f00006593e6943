#include "simulation/mesh/mesh_checks.h"

#include <gtest/gtest.h>

#include "runtime/error.h"

namespace weft {
namespace {

TriangleMesh fan(int triangles) {
    TriangleMesh mesh;
    mesh.source = "fan";
    mesh.positions = {{0, 0, 0}, {0, 0, 1}};
    for (int t = 0; t < triangles; ++t) {
        mesh.positions.push_back({1.0 + t, 0.5 * t, 0});
        mesh.triangles.push_back({0, 1, 2 + t});
    }
    mesh.parts = {{"all", 0, triangles}};
    return mesh;
}

TEST(MeshChecks, WarnsOfCrowdedEdges) {
    Warnings warnings;
    warn_of_odd_topology(fan(2), warnings);
    EXPECT_TRUE(warnings.empty());
    warn_of_odd_topology(fan(3), warnings);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("fan: 1 edges have more than two triangles"), std::string::npos);
    EXPECT_NE(warnings[0].find("vertices 1 and 2"), std::string::npos);
}

TEST(MeshChecks, WarnsOfVerticesWithoutTriangles) {
    TriangleMesh mesh = fan(1);
    mesh.positions.push_back({9, 9, 9});
    Warnings warnings;
    warn_of_odd_topology(mesh, warnings);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("1 vertices belong to no triangle"), std::string::npos);
    EXPECT_NE(warnings[0].find("vertex 4"), std::string::npos);
}

TEST(MeshChecks, DropsRepeatedTriangles) {
    TriangleMesh mesh = fan(2);
    mesh.triangles = {{0, 1, 2}, {2, 1, 0}, {0, 1, 3}, {1, 2, 0}};
    mesh.parts = {{"a", 0, 2}, {"b", 2, 1}, {"c", 3, 1}};
    Warnings warnings;
    drop_duplicates(mesh, warnings);
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 1, 3}}));
    ASSERT_EQ(mesh.parts.size(), 2U);
    EXPECT_EQ(mesh.parts[1].name, "b");
    EXPECT_EQ(mesh.parts[1].first_triangle, 1);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("2 triangles repeat"), std::string::npos);
    EXPECT_NE(warnings[0].find("triangle 2 "), std::string::npos);
}

TEST(MeshChecks, RefusesTrianglesWithoutArea) {
    EXPECT_NO_THROW(check_areas(fan(3)));
    TriangleMesh needle = fan(1);
    needle.positions[2] = {0, 0, 2};
    EXPECT_THROW(check_areas(needle), UserError);
    needle.positions[2] = needle.positions[0];
    EXPECT_THROW(check_areas(needle), UserError);
    // Apart in double precision, the same place in single precision.
    TriangleMesh far_off = fan(1);
    for (Vec3& p : far_off.positions) p = Vec3{1000, 1000, 1000} + 1e-6 * p;
    EXPECT_THROW(check_areas(far_off), UserError);
}

}  // namespace
}  // namespace weft
