#include "tests/simulation/topology/invariants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace weft::test {
namespace {

bool is_permutation_of_indices(std::vector<int> values, int count) {
    std::ranges::sort(values);
    std::vector<int> indices(static_cast<std::size_t>(count));
    std::iota(indices.begin(), indices.end(), 0);
    return values == indices;
}

/// Strips by old vertex, found by walking through the strips.
std::vector<int> strip_by_old_vertex(const Strips& strips) {
    std::vector<int> result(strips.order.size(), -1);
    for (int s = 0; s < strips.count(); ++s) {
        for (int v = strips.begin[s]; v < strips.begin[s + 1]; ++v) result[strips.order[v]] = s;
    }
    return result;
}

std::set<int> touched_strips(std::span<const int> old_vertices, const std::vector<int>& strip_of) {
    std::set<int> touched;
    for (int v : old_vertices) touched.insert(strip_of[v]);
    return touched;
}

void expect_order(int vertex_count, const Strips& strips) {
    ASSERT_TRUE(is_permutation_of_indices(strips.order, vertex_count));
    ASSERT_EQ(strips.rank.size(), strips.order.size());
    for (int v = 0; v < vertex_count; ++v) EXPECT_EQ(strips.rank[strips.order[v]], v);
    ASSERT_FALSE(strips.begin.empty());
    EXPECT_EQ(strips.begin.front(), 0);
    EXPECT_EQ(strips.begin.back(), vertex_count);
    for (int s = 0; s < strips.count(); ++s) EXPECT_LT(strips.begin[s], strips.begin[s + 1]);
    EXPECT_EQ(strips.seam_count(), std::max(0, strips.count() - 1));
    EXPECT_EQ(strips.seam_end.size(), strips.seam_begin.size());
    for (int v = 0; v < vertex_count; ++v) {
        EXPECT_LE(strips.begin[strips.strip_of(v)], v);
        EXPECT_GT(strips.begin[strips.strip_of(v) + 1], v);
    }
}

/// New vertices of each seam's elements; checks on the way that no element touches three strips.
std::vector<std::set<int>> collect_seams(const TopologyMesh& mesh, const Strips& strips) {
    const std::vector<int> strip_of = strip_by_old_vertex(strips);
    std::vector<std::set<int>> seams(static_cast<std::size_t>(strips.seam_count()));
    for (const Stencils& kind : mesh.kinds) {
        for (int e = 0; e < kind.count(); ++e) {
            const std::set<int> touched = touched_strips(kind[e], strip_of);
            EXPECT_LE(*touched.rbegin() - *touched.begin(), 1) << "element " << e;
            if (touched.size() != 2) continue;
            for (int v : kind[e]) seams[*touched.begin()].insert(strips.rank[v]);
        }
    }
    return seams;
}

void expect_hulls(const std::vector<std::set<int>>& seams, const Strips& strips) {
    for (int s = 0; s < strips.seam_count(); ++s) {
        const int begin = strips.seam_begin[s], end = strips.seam_end[s];
        if (seams[s].empty()) {
            EXPECT_EQ(begin, strips.begin[s + 1]);
            EXPECT_EQ(end, strips.begin[s + 1]);
        } else {
            EXPECT_EQ(begin, *seams[s].begin());
            EXPECT_EQ(end, *seams[s].rbegin() + 1);
        }
        EXPECT_GE(begin, strips.begin[s]);
        EXPECT_LE(end, strips.begin[s + 2]);
        EXPECT_GE(begin, s > 0 ? strips.seam_end[s - 1] : 0);
    }
}

/// Grows the set by all elements that touch it.
std::set<int> grown(const std::set<int>& vertices, const TopologyMesh& mesh, const Strips& strips) {
    std::set<int> result = vertices;
    for (const Stencils& kind : mesh.kinds) {
        for (int e = 0; e < kind.count(); ++e) {
            const auto is_inside = [&](int v) { return vertices.contains(strips.rank[v]); };
            if (!std::ranges::any_of(kind[e], is_inside)) continue;
            for (int v : kind[e]) result.insert(strips.rank[v]);
        }
    }
    return result;
}

void expect_seams_apart(const std::vector<std::set<int>>& seams, const TopologyMesh& mesh,
                        const Strips& strips, int extra_levels) {
    for (std::size_t s = 0; s < seams.size(); ++s) {
        std::set<int> near = seams[s];
        for (int i = 0; i < extra_levels; ++i) near = grown(near, mesh, strips);
        for (std::size_t other = 0; other < seams.size(); ++other) {
            if (other == s) continue;
            for (int v : seams[other]) {
                EXPECT_FALSE(near.contains(v)) << "seams " << s << ", " << other;
            }
        }
    }
}

/// The lowest old vertex of each vertex's component, by sweeping until nothing changes.
std::vector<int> component_of(const TopologyMesh& mesh) {
    std::vector<int> component(static_cast<std::size_t>(mesh.vertex_count));
    std::iota(component.begin(), component.end(), 0);
    for (bool changed = true; changed;) {
        changed = false;
        for (const Stencils& kind : mesh.kinds) {
            for (int e = 0; e < kind.count(); ++e) {
                int lowest = mesh.vertex_count;
                for (int v : kind[e]) lowest = std::min(lowest, component[v]);
                for (int v : kind[e]) {
                    changed |= component[v] != lowest;
                    component[v] = lowest;
                }
            }
        }
    }
    return component;
}

int phase_of(const std::set<int>& strips) { return strips.size() == 2 ? kSeamPhase : kInnerPhase; }

void expect_segment(const Stencils& kind, const std::vector<int>& strip_of,
                    const ElementLayout& layout, int phase, int colour, int strip) {
    const int segment = layout.segment(phase, colour, strip);
    int previous = 0;
    for (int i = layout.segment_begin[segment]; i < layout.segment_begin[segment + 1]; ++i) {
        const std::set<int> touched = touched_strips(kind[layout.order[i]], strip_of);
        EXPECT_EQ(*touched.begin(), strip);
        EXPECT_EQ(phase_of(touched), phase);
        EXPECT_LE(previous, std::ranges::min(layout.stencils[i])) << "segment not by lowest vertex";
        previous = std::ranges::min(layout.stencils[i]);
    }
}

void expect_colours(const ElementLayout& layout, int vertex_count) {
    for (int phase = 0; phase < kPhaseCount; ++phase) {
        for (int colour = 0; colour < layout.colour_count[phase]; ++colour) {
            std::vector<bool> met(static_cast<std::size_t>(vertex_count), false);
            int count = 0;
            for (int strip = 0; strip < layout.strip_count; ++strip) {
                const ElementRange range = layout.elements(phase, colour, strip);
                count += range.count();
                for (int i = range.begin; i < range.end; ++i) {
                    for (int v : layout.stencils[i]) {
                        EXPECT_FALSE(met[v]) << "phase " << phase << " colour " << colour;
                        met[v] = true;
                    }
                }
            }
            EXPECT_GT(count, 0);
        }
    }
}

void expect_counts(const ElementLayout& layout) {
    int total = 0;
    for (int phase = 0; phase < kPhaseCount; ++phase) {
        for (int strip = 0; strip < layout.strip_count; ++strip) {
            int count = 0;
            for (int colour = 0; colour < layout.colour_count[phase]; ++colour) {
                count += layout.elements(phase, colour, strip).count();
            }
            EXPECT_EQ(layout.item_count(phase, strip, strip + 1), count);
            const bool has_seam = strip + 1 < layout.strip_count;
            EXPECT_TRUE(count == 0 || phase == kInnerPhase || has_seam);
            total += count;
        }
        EXPECT_EQ(layout.item_count(phase, 0, layout.strip_count / 2) +
                      layout.item_count(phase, layout.strip_count / 2, layout.strip_count),
                  layout.item_count(phase, 0, layout.strip_count));
    }
    EXPECT_EQ(total, layout.stencils.count());
}

}  // namespace

void expect_valid_strips(const TopologyMesh& mesh, const Strips& strips, int extra_levels) {
    ASSERT_NO_FATAL_FAILURE(expect_order(mesh.vertex_count, strips));
    const std::vector<std::set<int>> seams = collect_seams(mesh, strips);
    expect_hulls(seams, strips);
    expect_seams_apart(seams, mesh, strips, extra_levels);
    const std::vector<int> component = component_of(mesh);
    for (int v = 1; v < mesh.vertex_count; ++v) {
        EXPECT_LE(component[strips.order[v - 1]], component[strips.order[v]]);
    }
}

void expect_valid_layout(const Stencils& kind, const Strips& strips, const ElementLayout& layout) {
    ASSERT_EQ(layout.strip_count, strips.count());
    ASSERT_EQ(layout.stencils.arity, kind.arity);
    ASSERT_TRUE(is_permutation_of_indices(layout.order, kind.count()));
    ASSERT_EQ(layout.stencils.count(), kind.count());
    for (int i = 0; i < kind.count(); ++i) {
        for (std::size_t k = 0; k < kind[0].size(); ++k) {
            EXPECT_EQ(layout.stencils[i][k], strips.rank[kind[layout.order[i]][k]]);
        }
    }
    ASSERT_EQ(layout.segment_begin.size(), static_cast<std::size_t>(layout.segment_count()) + 1);
    EXPECT_EQ(layout.segment_begin.front(), 0);
    EXPECT_EQ(layout.segment_begin.back(), kind.count());
    EXPECT_TRUE(std::ranges::is_sorted(layout.segment_begin));
    const std::vector<int> strip_of = strip_by_old_vertex(strips);
    for (int phase = 0; phase < kPhaseCount; ++phase) {
        for (int colour = 0; colour < layout.colour_count[phase]; ++colour) {
            for (int strip = 0; strip < layout.strip_count; ++strip) {
                expect_segment(kind, strip_of, layout, phase, colour, strip);
            }
        }
    }
    expect_colours(layout, static_cast<int>(strips.rank.size()));
    expect_counts(layout);
}

}  // namespace weft::test
