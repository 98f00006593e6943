#include "simulation/mesh/weld.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/error.h"

namespace weft {
namespace {

using Pair = std::array<int, 2>;

/// Two unit squares side by side with a border of their own each: 1 and 4 lie in one place, and so
/// do 2 and 7.
TriangleMesh two_squares() {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                      {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
    return mesh;
}

std::vector<Pair> found(const TriangleMesh& mesh) {
    std::vector<Pair> pairs = coincident_border(mesh, weld_reach(mesh));
    for (Pair& pair : pairs) std::ranges::sort(pair);
    std::ranges::sort(pairs);
    return pairs;
}

TEST(Weld, FindsWhatLiesTogether) {
    TriangleMesh mesh = two_squares();
    EXPECT_EQ(found(mesh), (std::vector<Pair>{{1, 4}, {2, 7}}));
    mesh.positions[4].y = 0.0099;
    EXPECT_EQ(found(mesh), (std::vector<Pair>{{1, 4}, {2, 7}})) << "a hundredth of an edge";
    mesh.positions[4].y = -0.0101;
    EXPECT_EQ(found(mesh), (std::vector<Pair>{{2, 7}})) << "and no more";
}

TEST(Weld, ReachIsThatOfTheShortestEdgeAtEither) {
    TriangleMesh mesh = two_squares();
    mesh.positions[5] = {1.1, 0.0, 0.0};
    const std::vector<double> reach = weld_reach(mesh);
    EXPECT_NEAR(reach[1], 0.01, 1e-12);
    EXPECT_NEAR(reach[4], 0.001, 1e-12);
    mesh.positions[1].y = 0.0011;
    EXPECT_EQ(found(mesh), (std::vector<Pair>{{2, 7}}));
    mesh.positions[1].y = 0.0009;
    EXPECT_EQ(found(mesh), (std::vector<Pair>{{1, 4}, {2, 7}}));
}

TEST(Weld, LeavesTheInsideAlone) {
    // Two fans around middles in one place, their borders apart.
    TriangleMesh mesh;
    for (const double z : {-0.5, 0.5}) {
        const int first = mesh.vertex_count();
        mesh.positions.insert(mesh.positions.end(),
                              {{0, 0, 0}, {1, 0, z}, {-0.5, 1, z}, {-0.5, -1, z}});
        for (int k = 0; k < 3; ++k) {
            mesh.triangles.push_back({first, first + 1 + k, first + 1 + (k + 1) % 3});
        }
    }
    EXPECT_TRUE(found(mesh).empty());
}

TEST(Weld, VerticesWithoutATriangleHaveNoReach) {
    TriangleMesh mesh = two_squares();
    mesh.positions.push_back({1, 0, 0});
    EXPECT_EQ(weld_reach(mesh).back(), 0.0);
}

TEST(Weld, MakesOneVertexOfTwo) {
    TriangleMesh mesh = two_squares();
    mesh.positions[7].x = 1.001;
    weld(mesh, std::vector<Pair>{{4, 1}, {2, 7}}, "here");
    EXPECT_EQ(
        mesh.positions,
        (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}}));
    EXPECT_EQ(mesh.triangles,
              (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}));
    EXPECT_EQ(mesh.welded, (std::vector{0, 1, 2, 3, 1, 4, 5, 2}));
    EXPECT_EQ(mesh.number_in_file(1), 1);
    EXPECT_EQ(mesh.number_in_file(4), 5);
}

TEST(Weld, ChainsOfPairsAreOneVertex) {
    TriangleMesh mesh;
    mesh.positions.resize(9);
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
    weld(mesh, std::vector<Pair>{{8, 5}, {1, 5}}, "here");
    EXPECT_EQ(mesh.welded, (std::vector{0, 1, 2, 3, 4, 1, 5, 6, 1}));
    EXPECT_EQ(mesh.positions.size(), 7U);
}

std::string refusal(const std::vector<Pair>& pairs) {
    TriangleMesh mesh = two_squares();
    try {
        weld(mesh, pairs, "s.toml:3:1");
    } catch (const UserError& error) {
        return error.what();
    }
    return "no error";
}

TEST(Weld, TrianglesKeepThreeCornersOfTheirOwn) {
    EXPECT_EQ(refusal({{0, 4}, {1, 4}}),
              "s.toml:3:1: the triangle over the vertices 0, 1, 2 (counted from 0) would have two "
              "corners in one, and no area");
    EXPECT_EQ(refusal({{0, 6}, {1, 4}, {2, 5}}),
              "s.toml:3:1: the triangles over the vertices 0, 1, 2 and 4, 5, 6 (counted from 0) "
              "would have the same corners: they lie upon each other, and only two of these may "
              "become one each");
    EXPECT_EQ(refusal({{1, 4}, {2, 7}}), "no error");
}

}  // namespace
}  // namespace weft
