#include "simulation/topology/vertex_layout.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "simulation/topology/vertex_graph.h"
#include "tests/simulation/topology/meshes.h"

namespace weft::test {
namespace {

struct Place {
    int phase = -1;
    int strip = -1;
    int colour = -1;
};

/// Straight from what the header promises.
void expect_valid(std::span<const Stencils> kinds, const Strips& strips,
                  const VertexLayout& layout) {
    const std::size_t count = strips.order.size();
    ASSERT_EQ(layout.vertices.size(), count);
    ASSERT_EQ(layout.segment_begin.size(), static_cast<std::size_t>(layout.segment_count()) + 1);
    ASSERT_EQ(layout.segment_begin.front(), 0);
    ASSERT_EQ(layout.segment_begin.back(), static_cast<int>(count));
    const VertexGraph graph(static_cast<int>(count), kinds);
    std::vector<Place> places(count);
    for (int phase = 0; phase < kPhaseCount; ++phase) {
        for (int strip = 0; strip < layout.strip_count; ++strip) {
            for (int c = 0; c < layout.colour_count[static_cast<std::size_t>(phase)]; ++c) {
                const auto segment = static_cast<std::size_t>(layout.segment(phase, c, strip));
                std::pair<long, int> last{-1000000, -1};
                for (int i = layout.segment_begin[segment]; i < layout.segment_begin[segment + 1];
                     ++i) {
                    const int v = layout.vertices[static_cast<std::size_t>(i)];
                    const std::pair own{-std::ssize(graph.neighbours(v)), v};
                    EXPECT_GT(own, last) << "ascending within a segment";
                    last = own;
                    EXPECT_EQ(places[static_cast<std::size_t>(v)].phase, -1) << "named twice";
                    places[static_cast<std::size_t>(v)] = {phase, strip, c};
                }
            }
        }
    }
    const auto place = [&](int v) { return places[static_cast<std::size_t>(v)]; };
    for (const Stencils& kind : kinds) {
        for (int e = 0; e < kind.count(); ++e) {
            for (const int a : kind[e]) {
                for (const int b : kind[e]) {
                    if (a == b) continue;
                    const bool crosses = strips.strip_of(a) != strips.strip_of(b);
                    if (crosses) {
                        EXPECT_EQ(place(a).phase, kSeamPhase);
                        EXPECT_EQ(place(a).strip, std::min(strips.strip_of(a), strips.strip_of(b)));
                    }
                    if (place(a).phase != place(b).phase) continue;
                    EXPECT_EQ(place(a).strip, place(b).strip) << "neighbours of one phase";
                    EXPECT_NE(place(a).colour, place(b).colour);
                }
            }
        }
    }
    for (std::size_t v = 0; v < count; ++v) {
        if (places[v].phase == kSeamPhase) continue;
        EXPECT_EQ(places[v].strip, strips.strip_of(static_cast<int>(v)));
    }
}

TEST(VertexLayout, KeepsItsInvariantsOnEveryMesh) {
    for (const int target : {32, 100000}) {
        for (const TopologyMesh& mesh : all_meshes()) {
            SCOPED_TRACE(mesh.name);
            const Strips strips = make_strips(
                mesh.vertex_count, mesh.kinds,
                {.target_strips = target, .min_vertices_per_strip = 1, .extra_levels = 1});
            const auto kinds = in_new_vertices(mesh, strips);
            expect_valid(kinds, strips, make_vertex_layout(kinds, strips));
        }
    }
}

TEST(VertexLayout, GridTakesFewColoursOfAboutEqualSize) {
    const TopologyMesh mesh = cloth("grid", 10000, grid_triangles(100, 100));
    const Strips strips = make_strips(mesh.vertex_count, mesh.kinds, {.extra_levels = 1});
    EXPECT_GE(strips.count(), 10);
    const auto kinds = in_new_vertices(mesh, strips);
    const VertexLayout layout = make_vertex_layout(kinds, strips);
    // The four corners of a hinge are all neighbours.
    EXPECT_GE(layout.colour_count[kInnerPhase], 4);
    EXPECT_LE(layout.colour_count[kInnerPhase], 9);
    EXPECT_LE(layout.colour_count[kSeamPhase], 9);

    const VertexLayout springs = make_vertex_layout({kinds.data(), 1}, strips);
    EXPECT_LE(springs.colour_count[kInnerPhase], 4);
}

}  // namespace
}  // namespace weft::test
