#include <gtest/gtest.h>

#include <algorithm>

#include "simulation/topology/strips.h"
#include "tests/simulation/topology/invariants.h"
#include "tests/simulation/topology/meshes.h"

namespace weft::test {
namespace {

std::vector<int> strip_sizes(const Strips& strips) {
    std::vector<int> sizes;
    for (int s = 0; s < strips.count(); ++s) sizes.push_back(strips.begin[s + 1] - strips.begin[s]);
    return sizes;
}

TEST(Strips, KeepTheirInvariantsOnEveryMesh) {
    for (const TopologyMesh& mesh : all_meshes()) {
        SCOPED_TRACE(mesh.name);
        expect_valid_strips(mesh, make_strips(mesh.vertex_count, mesh.kinds));
    }
}

TEST(Strips, KeepTheirInvariantsWhenCutAsThinAsPossible) {
    const StripOptions options{.target_strips = 100000, .min_vertices_per_strip = 1};
    for (const TopologyMesh& mesh : all_meshes()) {
        SCOPED_TRACE(mesh.name);
        expect_valid_strips(mesh, make_strips(mesh.vertex_count, mesh.kinds, options));
    }
}

TEST(Strips, ExtraLevelsKeepSeamsFurtherApart) {
    for (int extra_levels : {1, 2}) {
        const StripOptions options{
            .target_strips = 100000, .min_vertices_per_strip = 1, .extra_levels = extra_levels};
        for (const TopologyMesh& mesh : {chain(200), cloth("grid", 400, grid_triangles(20, 20)),
                                         shuffled_cloth("ribbon", 600, grid_triangles(3, 200), 1),
                                         tetrahedra_block(12, 2, 2)}) {
            SCOPED_TRACE(mesh.name);
            const Strips strips = make_strips(mesh.vertex_count, mesh.kinds, options);
            expect_valid_strips(mesh, strips, extra_levels);
            EXPECT_GT(strips.count(), 1);
        }
    }
}

TEST(Strips, AreNotThickerThanTheElementsNeed) {
    const auto inner_size = [](const TopologyMesh& mesh, int extra_levels) {
        const StripOptions options{
            .target_strips = 100000, .min_vertices_per_strip = 1, .extra_levels = extra_levels};
        return strip_sizes(make_strips(mesh.vertex_count, mesh.kinds, options)).at(5);
    };
    EXPECT_EQ(inner_size(chain(100), 0), 2);  // springs: two levels
    EXPECT_EQ(inner_size(chain(100), 1), 3);
    EXPECT_EQ(inner_size(tetrahedra_block(40, 1, 1), 0), 8);  // tetrahedra: two levels of four
    // Hinges on a ribbon: four vertices in a row, of which a seam may take three on either side.
    EXPECT_LE(inner_size(cloth("ribbon", 400, grid_triangles(2, 200)), 0), 8);
}

TEST(Strips, NoVerticesNoStrips) {
    const Strips strips = make_strips(0, {});
    EXPECT_EQ(strips.count(), 0);
    EXPECT_EQ(strips.seam_count(), 0);
}

TEST(Strips, SmallMeshesHaveFewStripsAndLargeOnesManySmallOnes) {
    EXPECT_EQ(make_strips(100, cloth("", 100, grid_triangles(10, 10)).kinds).count(), 1);
    const TopologyMesh mesh = cloth("", 40000, grid_triangles(200, 200));
    const Strips strips = make_strips(40000, mesh.kinds, {.max_vertices_per_strip = 800});
    EXPECT_NEAR(strips.count(), 50, 4);
}

TEST(Strips, SmallComponentsShareStripsWithoutSeams) {
    Triangles triangles;
    for (int patch = 0; patch < 500; ++patch) {
        for (int v : grid_triangles(4, 4)) triangles.push_back(patch * 16 + v);
    }
    const TopologyMesh mesh = cloth("patches", 8000, triangles);
    const Strips strips = make_strips(8000, mesh.kinds);
    EXPECT_EQ(strips.count(), 32);
    EXPECT_EQ(strips.seam_begin, strips.seam_end);
    EXPECT_LE(std::ranges::max(strip_sizes(strips)), 18 * 16);
}

TEST(Strips, MeshesThatAreShortInLevelsAreNotCut) {
    const TopologyMesh fan = cloth("fan", 501, disc_triangles(1, 500));
    EXPECT_EQ(make_strips(501, fan.kinds).count(), 1);
}

TEST(Strips, BodiesKeepTheirRanges) {
    Triangles triangles = grid_triangles(30, 30);
    for (int v : grid_triangles(20, 20)) triangles.push_back(900 + v);
    const Strips strips = make_strips(1300, cloth("two", 1300, triangles).kinds);
    for (int v = 0; v < 1300; ++v) EXPECT_EQ(strips.rank[v] < 900, v < 900);
}

TEST(Strips, HaveAboutEqualSizesOnAGrid) {
    for (const TopologyMesh& mesh :
         {cloth("rows", 40000, grid_triangles(200, 200)),
          shuffled_cloth("shuffled", 40000, grid_triangles(200, 200), 1)}) {
        const Strips strips = make_strips(mesh.vertex_count, mesh.kinds);
        EXPECT_NEAR(strips.count(), 32, 2);
        EXPECT_GE(std::ranges::min(strip_sizes(strips)), 1100);
        EXPECT_LE(std::ranges::max(strip_sizes(strips)), 1400);
    }
}

TEST(Strips, AreTheSameEveryTime) {
    const TopologyMesh mesh = shuffled_cloth("", 1600, grid_triangles(40, 40), 9);
    const Strips a = make_strips(mesh.vertex_count, mesh.kinds);
    const Strips b = make_strips(mesh.vertex_count, mesh.kinds);
    EXPECT_EQ(a.order, b.order);
    EXPECT_EQ(a.begin, b.begin);
    EXPECT_EQ(a.seam_begin, b.seam_begin);
    EXPECT_EQ(a.seam_end, b.seam_end);
}

}  // namespace
}  // namespace weft::test
