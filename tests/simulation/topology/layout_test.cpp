#include <gtest/gtest.h>

#include "simulation/topology/layout.h"
#include "tests/simulation/topology/invariants.h"
#include "tests/simulation/topology/meshes.h"

namespace weft::test {
namespace {

TEST(Layout, KeepsItsInvariantsOnEveryMesh) {
    for (const StripOptions& options :
         {StripOptions{}, StripOptions{.target_strips = 100000, .min_vertices_per_strip = 1}}) {
        for (const TopologyMesh& mesh : all_meshes()) {
            SCOPED_TRACE(mesh.name);
            const Strips strips = make_strips(mesh.vertex_count, mesh.kinds, options);
            for (const Stencils& kind : mesh.kinds) {
                expect_valid_layout(kind, strips, make_layout(kind, strips));
            }
        }
    }
}

TEST(Layout, OfNoElementsIsEmpty) {
    const Stencils none{.arity = 4, .vertices = {}};
    const ElementLayout layout = make_layout(none, make_strips(10, {&none, 1}));
    EXPECT_EQ(layout.colour_count[kSeamPhase] + layout.colour_count[kInnerPhase], 0);
    EXPECT_EQ(layout.item_count(kInnerPhase, 0, 1), 0);
}

TEST(Layout, OneColourForElementsThatShareNoVertex) {
    const Stencils springs{.arity = 2, .vertices = {0, 1, 2, 3, 4, 5}};
    const ElementLayout layout = make_layout(springs, make_strips(6, {&springs, 1}));
    EXPECT_EQ(layout.colour_count[kInnerPhase], 1);
    EXPECT_EQ(layout.elements(kInnerPhase, 0, 0).count(), 3);
}

TEST(Layout, MoreThanSixtyFourColoursWhereAVertexNeedsThem) {
    const TopologyMesh fan = cloth("fan", 301, disc_triangles(1, 300));
    const Strips strips = make_strips(fan.vertex_count, fan.kinds);
    const ElementLayout layout = make_layout(fan.kinds[0], strips);
    EXPECT_GE(layout.colour_count[kInnerPhase], 300);
    EXPECT_LE(layout.colour_count[kInnerPhase], 303);
}

TEST(Layout, GridTakesFewColoursAndFewSeamElements) {
    struct Limit {
        double seam_share;
        int seam_colours, inner_colours;
    };
    for (const bool is_shuffled : {false, true}) {
        const Triangles triangles = grid_triangles(200, 200);
        const TopologyMesh mesh = is_shuffled ? shuffled_cloth("shuffled", 40000, triangles, 1)
                                              : cloth("rows", 40000, triangles);
        const Strips strips = make_strips(mesh.vertex_count, mesh.kinds);
        // Inside, no colouring takes fewer than 6 and 12.
        const Limit limits[] = {{0.08, 4, 7}, {0.16, 10, 16}};
        for (std::size_t k = 0; k < mesh.kinds.size(); ++k) {
            const ElementLayout layout = make_layout(mesh.kinds[k], strips);
            const double most = limits[k].seam_share * mesh.kinds[k].count();
            EXPECT_LE(layout.item_count(kSeamPhase, 0, strips.count()), most);
            EXPECT_LE(layout.colour_count[kSeamPhase], limits[k].seam_colours);
            EXPECT_LE(layout.colour_count[kInnerPhase], limits[k].inner_colours);
        }
    }
}

TEST(Layout, ColoursOfAStripAreOfAboutEqualSize) {
    const TopologyMesh mesh = cloth("grid", 40000, grid_triangles(200, 200));
    const StripOptions one_strip{.target_strips = 1, .max_vertices_per_strip = 40000};
    const Strips strips = make_strips(mesh.vertex_count, mesh.kinds, one_strip);
    const ElementLayout layout = make_layout(mesh.kinds[0], strips);
    const int mean = mesh.kinds[0].count() / layout.colour_count[kInnerPhase];
    for (int colour = 0; colour < layout.colour_count[kInnerPhase]; ++colour) {
        EXPECT_NEAR(layout.elements(kInnerPhase, colour, 0).count(), mean, mean / 10);
    }
}

}  // namespace
}  // namespace weft::test
