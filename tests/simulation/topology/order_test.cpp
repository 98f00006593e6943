#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include "simulation/topology/stencil_layout.h"
#include "tests/simulation/topology/meshes.h"

namespace weft::test {
namespace {

// The order of vertices and elements defines the result of every run: where a fingerprint moves,
// so do the state hashes of scenes, and traces and checkpoints of before are of no use.

class Fingerprint {
public:
    void add(std::span<const int> numbers) {
        for (const int number : numbers) {
            value_ = (value_ ^ static_cast<std::uint32_t>(number)) * 0x100000001b3u;  // FNV-1a
        }
    }
    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325u;
};

/// Long and short ones, thick and thin ones, and some of which only a part is cut.
std::vector<TopologyMesh> meshes() {
    std::vector<TopologyMesh> list{chain(1),
                                   chain(700),
                                   cloth("grid", 6000, grid_triangles(60, 100)),
                                   cloth("ribbon", 12000, grid_triangles(3, 4000)),
                                   cloth("disc", 1 + 30 * 40, disc_triangles(30, 40)),
                                   tetrahedra_block(40, 6, 4)};
    // Many small ones behind each other, and a larger one.
    TopologyMesh several{"several", 2000, {{.arity = 2, .vertices = {}}}};
    for (int v = 0; v + 1 < several.vertex_count; ++v) {
        if (v < 1200 && v % 7 == 6) continue;
        several.kinds[0].vertices.insert(several.kinds[0].vertices.end(), {v, v + 1});
    }
    list.push_back(std::move(several));
    // Long, with levels and degrees that differ everywhere.
    TopologyMesh uneven{"uneven", 12000, {{.arity = 2, .vertices = {}}}};
    std::uint32_t random = 1;
    for (int v = 1; v < uneven.vertex_count; ++v) {
        for (int n = 0; n < 2; ++n) {
            random = random * 1664525u + 1013904223u;
            const int back = 1 + static_cast<int>(random >> 29);
            uneven.kinds[0].vertices.insert(uneven.kinds[0].vertices.end(),
                                            {v, std::max(v - back, 0)});
        }
    }
    list.push_back(std::move(uneven));
    return list;
}

template <class Add>
std::uint64_t fingerprint(const StripOptions& options, Add add) {
    Fingerprint print;
    for (const TopologyMesh& mesh : meshes()) {
        add(print, mesh, make_strips(mesh.vertex_count, mesh.kinds, options));
    }
    return print.value();
}

void add_strips(Fingerprint& print, const TopologyMesh&, const Strips& strips) {
    print.add(strips.order);
    print.add(strips.begin);
    print.add(strips.seam_begin);
    print.add(strips.seam_end);
}

void add_elements(Fingerprint& print, const TopologyMesh& mesh, const Strips& strips) {
    for (const Stencils& kind : mesh.kinds) {
        const ElementLayout layout = make_layout(kind, strips);
        print.add(layout.order);
        print.add(layout.segment_begin);
    }
}

/// Vertices of a segment do not see each other: in which order they lie there is no matter.
void add_vertices(Fingerprint& print, const TopologyMesh& mesh, const Strips& strips) {
    VertexLayout layout = make_vertex_layout(in_new_vertices(mesh, strips), strips);
    for (std::size_t s = 0; s + 1 < layout.segment_begin.size(); ++s) {
        std::sort(layout.vertices.begin() + layout.segment_begin[s],
                  layout.vertices.begin() + layout.segment_begin[s + 1]);
    }
    print.add(layout.vertices);
    print.add(layout.segment_begin);
}

constexpr StripOptions kUsual{.extra_levels = 1};
constexpr StripOptions kThin{
    .target_strips = 100000, .min_vertices_per_strip = 1, .extra_levels = 1};

TEST(OrderOfResults, IsThatOfBeforeInStrips) {
    EXPECT_EQ(fingerprint(kUsual, add_strips), 6866417464641180249u);
    EXPECT_EQ(fingerprint(kThin, add_strips), 17735284191033052159u);
}

TEST(OrderOfResults, IsThatOfBeforeInColoursOfElements) {
    EXPECT_EQ(fingerprint(kUsual, add_elements), 16791699844268127146u);
    EXPECT_EQ(fingerprint(kThin, add_elements), 16689625671476366142u);
}

TEST(OrderOfResults, IsThatOfBeforeInColoursOfVertices) {
    EXPECT_EQ(fingerprint(kUsual, add_vertices), 1649462080775458295u);
    EXPECT_EQ(fingerprint(kThin, add_vertices), 9604573319982700862u);
}

}  // namespace
}  // namespace weft::test
