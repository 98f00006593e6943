#include "simulation/mesh/rest_shape.h"

#include <gtest/gtest.h>

#include "simulation/mesh/generators.h"
#include "simulation/topology/adjacency.h"

namespace weft {
namespace {

/// Two triangles over the edge from 0 to 1, folded up where they are.
TriangleMesh folded() {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0, 3}};
    mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
    return mesh;
}

constexpr std::array<int, 4> kHinge{0, 1, 2, 3};

TEST(RestShape, IsThePlacedOneWhereNoOtherIsNamed) {
    const TriangleMesh mesh = folded();
    const RestShape rest(mesh);
    EXPECT_EQ(rest.length_of(1, 0), 2.0);
    EXPECT_EQ(rest.area_of(1), 3.0);
    EXPECT_EQ(rest.hinge(kHinge), (std::array{mesh.positions[0], mesh.positions[1],
                                              mesh.positions[2], mesh.positions[3]}));
}

TEST(RestShape, OfAnotherShapeIsThatOne) {
    TriangleMesh mesh = folded();
    mesh.rest = {{{{5, 0, 0}, {5, 4, 0}, {4, 2, 0}}}, {{{5, 4, 0}, {5, 0, 0}, {5, 2, 1}}}};
    const RestShape rest(mesh);
    EXPECT_EQ(rest.length_of(0, 1), 4.0);
    EXPECT_EQ(rest.area_of(0), 2.0);
    EXPECT_EQ(rest.hinge(kHinge),
              (std::array{Vec3{5, 0, 0}, Vec3{5, 4, 0}, Vec3{4, 2, 0}, Vec3{5, 2, 1}}));
}

/// Panels that lie apart, the second one with an edge half as long again.
TEST(RestShape, PanelsAreLaidFlatAtTheirSeam) {
    TriangleMesh mesh = folded();
    mesh.rest = {{{{0, 0, 0}, {2, 0, 0}, {1, 1, 0}}}, {{{9, 3, 7}, {9, 0, 7}, {9, 1, 5}}}};
    const RestShape rest(mesh);
    EXPECT_EQ(rest.length_of(0, 1), 2.5);
    const auto hinge = rest.hinge(kHinge);
    EXPECT_EQ(hinge[2], (Vec3{1, 1, 0}));
    // A third of the way from vertex 0 to 1, and 2 m across, away from the other tip.
    EXPECT_LT(length(hinge[3] - Vec3{2.0 / 3.0, -2, 0}), 1e-12);
}

TEST(RestShape, AllHingesOfAMeshThatIsItsOwnPatternAreUnchanged) {
    TriangleMesh mesh = make_cylinder({1.0, 2.0}, 1.5, {7, 4});
    std::vector<int> corners;
    for (const auto& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
    const Adjacency adjacency = find_adjacency(mesh.vertex_count(), corners);
    TriangleMesh own = mesh;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) own.rest.push_back(mesh.rest_of(t));
    const RestShape a(mesh), b(own);
    for (int h = 0; h < adjacency.hinges.count(); ++h) {
        EXPECT_EQ(a.hinge(adjacency.hinges[h]), b.hinge(adjacency.hinges[h]));
    }
    for (int e = 0; e < adjacency.edges.count(); ++e) {
        const auto ends = adjacency.edges[e];
        EXPECT_EQ(a.length_of(ends[0], ends[1]), b.length_of(ends[0], ends[1]));
    }
}

}  // namespace
}  // namespace weft
