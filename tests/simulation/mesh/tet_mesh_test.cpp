#include "simulation/mesh/tet_mesh.h"

#include <gtest/gtest.h>

#include <set>

#include "runtime/error.h"
#include "simulation/mesh/generators.h"
#include "simulation/mesh/tet_checks.h"

namespace weft {
namespace {

/// Two tetrahedra over the same face.
TetMesh two() {
    TetMesh mesh;
    mesh.source = "two";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    mesh.tetrahedra = {{0, 1, 2, 3}, {1, 2, 3, 4}};
    return mesh;
}

double volume(const TetMesh& mesh) {
    double sum = 0.0;
    for (const auto& t : mesh.tetrahedra) sum += six_volumes(mesh, t) / 6.0;
    return sum;
}

/// By the divergence theorem: right only if the faces are closed and face outward.
double volume_inside(const TetMesh& mesh, const std::vector<std::array<int, 3>>& faces) {
    double sum = 0.0;
    const auto at = [&](int v) { return mesh.positions[static_cast<std::size_t>(v)]; };
    for (const auto& [a, b, c] : faces) sum += dot(at(a), cross(at(b), at(c))) / 6.0;
    return sum;
}

TEST(Block, FillsItsVolumeWithPositiveTetrahedra) {
    for (const std::array<int, 3> resolution : {std::array{2, 2, 2}, {3, 4, 5}, {2, 7, 3}}) {
        const TetMesh mesh = make_block({1.0, 2.0, 0.5}, resolution);
        const auto [nx, ny, nz] = resolution;
        EXPECT_EQ(mesh.vertex_count(), nx * ny * nz);
        EXPECT_EQ(mesh.tetrahedron_count(), 6 * (nx - 1) * (ny - 1) * (nz - 1));
        for (const auto& t : mesh.tetrahedra) EXPECT_GT(six_volumes(mesh, t), 0.0);
        EXPECT_NEAR(volume(mesh), 1.0, 1e-12);

        const auto faces = boundary_faces(mesh);
        const int cells = (nx - 1) * (ny - 1) + (ny - 1) * (nz - 1) + (nx - 1) * (nz - 1);
        EXPECT_EQ(faces.size(), static_cast<std::size_t>(4 * cells)) << "neighbours fit together";
        EXPECT_NEAR(volume_inside(mesh, faces), 1.0, 1e-12);
    }
    const TetMesh mesh = make_block({1.0, 2.0, 0.5}, {3, 4, 5});
    EXPECT_EQ(mesh.positions[(4 * 4 + 3) * 3 + 2], (Vec3{0.5, 1.0, 0.25}));
    EXPECT_EQ(mesh.positions[1], (Vec3{0.0, -1.0, -0.25}));
}

/// An L of three of four squares, with two cells to each side of a square.
TEST(Block, HasItsOutline) {
    const std::vector<std::string> outline{"#.", "##"};
    const TetMesh mesh = make_outlined_block({1.0, 1.0, 0.5}, {5, 5, 3}, outline);
    EXPECT_EQ(mesh.tetrahedron_count(), 6 * 12 * 2);
    EXPECT_EQ(mesh.vertex_count(), 3 * (25 - 4));
    EXPECT_EQ(outlined_vertex_count({5, 5, 3}, outline), 3 * (25 - 4));
    EXPECT_NEAR(volume(mesh), 0.75 * 0.5, 1e-12);
    EXPECT_NEAR(volume_inside(mesh, boundary_faces(mesh)), 0.75 * 0.5, 1e-12);
    for (const Vec3& x : mesh.positions) {
        EXPECT_FALSE(x.x > 1e-9 && x.y > 1e-9) << "the upper right is not there";
    }
    EXPECT_EQ(mesh.positions.front(), (Vec3{-0.5, -0.5, -0.25}));
    // Cells that lie in two places are in that of their middle.
    EXPECT_EQ(make_outlined_block({1.0, 1.0, 0.5}, {4, 4, 2}, outline).tetrahedron_count(), 6 * 7);
}

TEST(TetMesh, BoundaryOfTwoLeavesTheirCommonFaceOut) {
    const TetMesh mesh = two();
    const auto faces = boundary_faces(mesh);
    EXPECT_EQ(faces.size(), 6U);
    for (const auto& face : faces) {
        EXPECT_NE((std::set<int>(face.begin(), face.end())), (std::set<int>{1, 2, 3}));
    }
    EXPECT_NEAR(volume_inside(mesh, faces), volume(mesh), 1e-15);
}

TEST(TetChecks, TurnsInvertedTetrahedra) {
    TetMesh mesh = two();
    std::swap(mesh.tetrahedra[1][0], mesh.tetrahedra[1][1]);
    Warnings warnings;
    turn_inverted(mesh, warnings);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(warnings[0],
              "two: 1 tetrahedra are inverted and get their last two vertices exchanged, the first "
              "is tetrahedron 2 (counted from 1)");
    EXPECT_NEAR(volume(mesh), volume(two()), 1e-15);
    turn_inverted(mesh, warnings);
    EXPECT_EQ(warnings.size(), 1U);
}

TEST(TetChecks, DropsRepeatedTetrahedra) {
    TetMesh mesh = two();
    mesh.tetrahedra.insert(mesh.tetrahedra.begin() + 1, {3, 0, 2, 1});
    Warnings warnings;
    drop_duplicates(mesh, warnings);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("1 tetrahedra repeat another one"), std::string::npos);
    EXPECT_NE(warnings[0].find("tetrahedron 2"), std::string::npos);
    EXPECT_EQ(mesh.tetrahedra, two().tetrahedra);
}

TEST(TetChecks, WarnsOfLonelyVerticesAndCrowdedFaces) {
    TetMesh mesh = two();
    Warnings warnings;
    warn_of_odd_topology(mesh, warnings);
    EXPECT_TRUE(warnings.empty());
    mesh.positions.push_back({2, 2, 2});
    mesh.positions.push_back({3, 3, 3});
    mesh.tetrahedra.push_back({1, 2, 3, 6});
    warn_of_odd_topology(mesh, warnings);
    ASSERT_EQ(warnings.size(), 2U);
    EXPECT_NE(warnings[0].find("1 faces have more than two tetrahedra"), std::string::npos);
    EXPECT_NE(warnings[0].find("vertices 2, 3, 4"), std::string::npos);
    EXPECT_NE(warnings[1].find("1 vertices belong to no tetrahedron"), std::string::npos);
    EXPECT_NE(warnings[1].find("vertex 6"), std::string::npos);
}

TEST(TetChecks, RefusesWhatHasNoVolumeInSinglePrecision) {
    TetMesh mesh = two();
    EXPECT_NO_THROW(check_volumes(mesh));
    mesh.positions[4] = {0.5, 0.5, 1e-9};
    mesh.tetrahedra = {{0, 1, 2, 4}};
    try {
        check_volumes(mesh);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_EQ(std::string(error.what())
                      .find("two: degenerate tetrahedron 1 over the vertices "
                            "1, 2, 3, 5"),
                  0U);
    }
    TetMesh far_away = two();
    for (Vec3& p : far_away.positions) p = 1e-4 * p + Vec3{1e4, 0, 0};
    EXPECT_THROW(check_volumes(far_away), UserError);
}

}  // namespace
}  // namespace weft
