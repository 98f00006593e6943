#include "simulation/topology/vertex_layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "tests/simulation/topology/meshes.h"

namespace weft::test {
namespace {

std::vector<Stencils> in_new_vertices(const TopologyMesh& mesh, const Strips& strips) {
    std::vector<Stencils> kinds = mesh.kinds;
    for (Stencils& kind : kinds) {
        for (int& v : kind.vertices) v = strips.rank[static_cast<std::size_t>(v)];
    }
    return kinds;
}

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
    std::vector<Place> places(count);
    for (int phase = 0; phase < kPhaseCount; ++phase) {
        for (int strip = 0; strip < layout.strip_count; ++strip) {
            for (int c = 0; c < layout.colour_count[static_cast<std::size_t>(phase)]; ++c) {
                const auto segment = static_cast<std::size_t>(layout.segment(phase, c, strip));
                int last = -1;
                for (int i = layout.segment_begin[segment]; i < layout.segment_begin[segment + 1];
                     ++i) {
                    const int v = layout.vertices[static_cast<std::size_t>(i)];
                    EXPECT_GT(v, last) << "ascending within a segment";
                    last = v;
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

TEST(StencilLayout, PairsAreIndependentAndEveryVertexIsThere) {
    for (const TopologyMesh& mesh : all_meshes()) {
        SCOPED_TRACE(mesh.name);
        const Strips strips = make_strips(mesh.vertex_count, mesh.kinds,
                                          {.min_vertices_per_strip = 1, .extra_levels = 1});
        const auto kinds = in_new_vertices(mesh, strips);
        if (kinds.empty() || kinds[0].arity != 2) continue;
        std::vector<int> order(static_cast<std::size_t>(kinds[0].count()));
        std::iota(order.begin(), order.end(), 0);
        const StencilLayout layout = make_stencil_layout(kinds, strips, kinds[0], order);

        std::vector<int> stencil_of(strips.order.size(), -1);
        std::vector<int> segment_of(strips.order.size(), -1);
        for (std::size_t s = 0; s + 1 < layout.segment_begin.size(); ++s) {
            ASSERT_EQ(layout.items.segment_begin[s], 2 * layout.segment_begin[s]);
            for (int i = layout.segment_begin[s]; i < layout.segment_begin[s + 1]; ++i) {
                const auto stencil = static_cast<std::size_t>(i);
                const auto [first, second] = layout.corners[stencil];
                const int a = layout.items.vertices[static_cast<std::size_t>(first)];
                const int b = layout.items.vertices[static_cast<std::size_t>(second)];
                const int pair = layout.stencils[stencil];
                EXPECT_EQ(pair < 0, a == b);
                if (pair >= 0) {
                    EXPECT_TRUE(std::ranges::is_permutation(kinds[0][pair], std::array{a, b}));
                }
                for (const int v : {a, b}) {
                    stencil_of[static_cast<std::size_t>(v)] = i;
                    segment_of[static_cast<std::size_t>(v)] = static_cast<int>(s);
                }
            }
        }
        EXPECT_EQ(std::ranges::count(stencil_of, -1), 0);
        for (const Stencils& kind : kinds) {
            for (int e = 0; e < kind.count(); ++e) {
                for (const int v : kind[e]) {
                    const auto a = static_cast<std::size_t>(kind[e][0]);
                    const auto b = static_cast<std::size_t>(v);
                    if (segment_of[a] != segment_of[b]) continue;
                    EXPECT_EQ(stencil_of[a], stencil_of[b]) << "neighbours of one colour";
                }
            }
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
