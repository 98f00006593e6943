#include "simulation/topology/stencil_layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/simulation/topology/meshes.h"

namespace weft::test {
namespace {

/// All elements with at most four corners, the larger ones first, each in its own order.
std::vector<StencilCandidates> candidates_of(const std::vector<Stencils>& kinds) {
    std::vector<StencilCandidates> candidates;
    for (auto kind = kinds.rbegin(); kind != kinds.rend(); ++kind) {
        StencilCandidates& added = candidates.emplace_back(StencilCandidates{*kind, {}});
        added.order.resize(static_cast<std::size_t>(kind->count()));
        std::iota(added.order.begin(), added.order.end(), 0);
    }
    return candidates;
}

/// Where each vertex is, by what the layout says.
struct Places {
    std::vector<int> family, stencil, segment;
};

Places expect_consistent(const std::vector<StencilCandidates>& candidates,
                         const StencilLayout& layout, std::size_t vertex_count) {
    Places places;
    for (auto* list : {&places.family, &places.stencil, &places.segment}) {
        list->assign(vertex_count, -1);
    }
    EXPECT_EQ(layout.items.vertices.size(), vertex_count) << "every vertex once";
    EXPECT_EQ(layout.families.size(), candidates.size() + 1);
    for (std::size_t f = 0; f < layout.families.size(); ++f) {
        const StencilLayout::Family& family = layout.families[f];
        EXPECT_EQ(family.segment_begin.size(), layout.items.segment_begin.size());
        EXPECT_EQ(family.segment_begin.back(), static_cast<int>(family.elements.size()));
        for (std::size_t s = 0; s + 1 < family.segment_begin.size(); ++s) {
            for (int i = family.segment_begin[s]; i < family.segment_begin[s + 1]; ++i) {
                const auto stencil = static_cast<std::size_t>(i);
                std::vector<int> vertices;
                for (int c = 0; c < family.arity; ++c) {
                    const int item = family.corners[stencil][static_cast<std::size_t>(c)];
                    EXPECT_GE(item, layout.items.segment_begin[s]);
                    EXPECT_LT(item, layout.items.segment_begin[s + 1]);
                    vertices.push_back(layout.items.vertices[static_cast<std::size_t>(item)]);
                    if (i == family.segment_begin[s]) continue;
                    const int before = family.corners[stencil - 1][static_cast<std::size_t>(c)];
                    EXPECT_EQ(item, before + 1) << "neighbours for neighbouring stencils";
                }
                const int element = family.elements[stencil];
                if (f == candidates.size()) {
                    EXPECT_EQ(vertices, std::vector{element});
                } else {
                    EXPECT_TRUE(std::ranges::equal(candidates[f].elements[element], vertices));
                }
                for (const int v : vertices) {
                    const auto vertex = static_cast<std::size_t>(v);
                    EXPECT_EQ(places.stencil[vertex], -1) << "named twice";
                    places.family[vertex] = static_cast<int>(f);
                    places.stencil[vertex] = i;
                    places.segment[vertex] = static_cast<int>(s);
                }
            }
        }
    }
    EXPECT_EQ(std::ranges::count(places.stencil, -1), 0);
    return places;
}

TEST(StencilLayout, StencilsAreElementsAndIndependentOfEachOther) {
    for (const int target : {32, 100000}) {
        for (const TopologyMesh& mesh : all_meshes()) {
            SCOPED_TRACE(mesh.name);
            const Strips strips = make_strips(
                mesh.vertex_count, mesh.kinds,
                {.target_strips = target, .min_vertices_per_strip = 1, .extra_levels = 1});
            const auto kinds = in_new_vertices(mesh, strips);
            const auto candidates = candidates_of(kinds);
            const StencilLayout layout = make_stencil_layout(kinds, strips, candidates);
            const Places places = expect_consistent(candidates, layout, strips.order.size());
            for (const Stencils& kind : kinds) {
                for (int e = 0; e < kind.count(); ++e) {
                    for (const int v : kind[e]) {
                        const auto a = static_cast<std::size_t>(kind[e][0]);
                        const auto b = static_cast<std::size_t>(v);
                        if (places.segment[a] != places.segment[b]) continue;
                        EXPECT_EQ(places.family[a], places.family[b]) << "neighbours of one colour";
                        EXPECT_EQ(places.stencil[a], places.stencil[b])
                            << "neighbours of one colour";
                    }
                }
            }
        }
    }
}

/// The share of vertices in stencils of elements.
double covered(const TopologyMesh& mesh, std::size_t kind) {
    const Strips strips = make_strips(mesh.vertex_count, mesh.kinds, {.extra_levels = 1});
    const auto kinds = in_new_vertices(mesh, strips);
    std::vector<StencilCandidates> candidates{{kinds[kind], {}}};
    candidates[0].order.resize(static_cast<std::size_t>(kinds[kind].count()));
    std::iota(candidates[0].order.begin(), candidates[0].order.end(), 0);
    const StencilLayout layout = make_stencil_layout(kinds, strips, candidates);
    return 1.0 - static_cast<double>(layout.families[1].elements.size()) /
                     static_cast<double>(mesh.vertex_count);
}

TEST(StencilLayout, CoversNearlyAllVerticesOfClothAndHalfOfSolids) {
    EXPECT_GT(covered(cloth("grid", 10000, grid_triangles(100, 100)), 0), 0.9);
    // Strips and seams of solids are few levels thick, and tetrahedra that reach out do not count.
    EXPECT_GT(covered(tetrahedra_block(40, 10, 10), 0), 0.4);
}

}  // namespace
}  // namespace weft::test
