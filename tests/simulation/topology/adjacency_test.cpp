#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "simulation/topology/adjacency.h"
#include "tests/simulation/topology/meshes.h"

namespace weft::test {
namespace {

using Edge = std::pair<int, int>;

TEST(Adjacency, OneTriangleHasThreeEdgesAndNoHinge) {
    const Adjacency adjacency = find_adjacency(3, Triangles{2, 0, 1});
    EXPECT_EQ(adjacency.edges.vertices, (std::vector<int>{0, 1, 0, 2, 1, 2}));
    EXPECT_EQ(adjacency.hinges.count(), 0);
}

TEST(Adjacency, HingeIsSharedEdgeThenOppositeVertices) {
    const Adjacency adjacency = find_adjacency(4, Triangles{1, 2, 0, 2, 1, 3});
    EXPECT_EQ(adjacency.edges.count(), 5);
    EXPECT_EQ(adjacency.hinges.vertices, (std::vector<int>{1, 2, 0, 3}));
}

TEST(Adjacency, HingeSidesFollowTheOrientationOfTheTriangles) {
    // The same two triangles in the other order, and with both turned over.
    EXPECT_EQ(find_adjacency(4, Triangles{2, 1, 3, 1, 2, 0}).hinges.vertices,
              (std::vector<int>{1, 2, 0, 3}));
    EXPECT_EQ(find_adjacency(4, Triangles{2, 1, 0, 1, 2, 3}).hinges.vertices,
              (std::vector<int>{1, 2, 3, 0}));
    // Both run from 1 to 2: the first triangle's vertex comes first.
    EXPECT_EQ(find_adjacency(4, Triangles{1, 2, 3, 1, 2, 0}).hinges.vertices,
              (std::vector<int>{1, 2, 3, 0}));
}

TEST(Adjacency, EdgesOfThreeTrianglesDegenerateTrianglesAndCopiesHaveNoHinge) {
    EXPECT_EQ(find_adjacency(5, Triangles{0, 1, 2, 1, 0, 3, 0, 1, 4}).hinges.count(), 0);
    EXPECT_EQ(find_adjacency(3, Triangles{0, 1, 1, 2, 2, 2}).edges.count(), 0);
    EXPECT_EQ(find_adjacency(3, Triangles{0, 1, 2, 2, 1, 0}).hinges.count(), 0);
}

TEST(Adjacency, EmptyMesh) {
    EXPECT_EQ(find_adjacency(0, {}).edges.count(), 0);
    EXPECT_EQ(find_adjacency(5, {}).edges.count(), 0);
}

TEST(Adjacency, GridHasTheEdgesAndHingesOfEulersFormula) {
    constexpr int kWidth = 17, kHeight = 9;
    const Adjacency adjacency = find_adjacency(kWidth * kHeight, grid_triangles(kWidth, kHeight));
    const int cells = (kWidth - 1) * (kHeight - 1), border = 2 * (kWidth - 1 + kHeight - 1);
    EXPECT_EQ(adjacency.edges.count(), kWidth * kHeight + 2 * cells - 1);
    EXPECT_EQ(adjacency.hinges.count(), adjacency.edges.count() - border);
}

/// Random triangles against a map from edge to opposite vertices.
TEST(Adjacency, AgreesWithAMapOnRandomTriangles) {
    const Triangles grid = grid_triangles(23, 19);
    Triangles triangles;
    for (std::size_t t = 0; t < grid.size(); t += 3) {
        const std::array<int, 3> corners{grid[t], grid[t + 1], grid[t + 2]};
        if (t % 7 == 0) continue;
        triangles.insert(triangles.end(), corners.begin(), corners.end());
        const int fin = static_cast<int>(t);
        if (t % 5 == 0) triangles.insert(triangles.end(), {corners[0], corners[1], fin});
    }
    const int vertex_count = 1 + *std::ranges::max_element(triangles);
    std::map<Edge, std::multiset<int>> opposite;
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
        std::set<int> corners(triangles.begin() + static_cast<long>(t),
                              triangles.begin() + static_cast<long>(t) + 3);
        if (corners.size() < 3) continue;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto edge = std::minmax(triangles[t + i], triangles[t + (i + 1) % 3]);
            opposite[Edge(edge)].insert(triangles[t + (i + 2) % 3]);
        }
    }
    const Adjacency adjacency = find_adjacency(vertex_count, triangles);
    ASSERT_EQ(adjacency.edges.count(), static_cast<int>(opposite.size()));
    int edge = 0, hinge = 0;
    for (const auto& [key, others] : opposite) {
        EXPECT_EQ(Edge(adjacency.edges[edge][0], adjacency.edges[edge][1]), key);
        ++edge;
        if (others.size() != 2 || *others.begin() == *others.rbegin()) continue;
        const std::span<const int> found = adjacency.hinges[hinge++];
        EXPECT_EQ(Edge(found[0], found[1]), key);
        EXPECT_EQ(std::multiset<int>({found[2], found[3]}), others);
    }
    EXPECT_EQ(adjacency.hinges.count(), hinge);
}

}  // namespace
}  // namespace weft::test
