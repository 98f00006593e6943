#include "simulation/contact/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <numeric>
#include <set>

#include "simulation/contact/patch_groups.h"
#include "tests/simulation/contact/contact_meshes.h"

namespace weft::test {
namespace {

class SurfaceOf : public testing::TestWithParam<std::size_t> {
protected:
    const ContactMesh mesh_ = contact_meshes()[GetParam()];
    const Surface s_ = make_surface(mesh_.mesh, mesh_.strips);

    void expect_without_slits(const PatchGroups& groups, const std::vector<int>& begin) const;
    int model(int vertex) const { return s_.vertices[static_cast<std::size_t>(vertex)]; }
    int strip_of_patch(int patch) const {
        const auto& begin = s_.strip_patches;
        return static_cast<int>(std::ranges::upper_bound(begin, patch) - begin.begin()) - 1;
    }
};

int patch_of(const std::vector<int>& begin, int item) {
    return static_cast<int>(std::ranges::upper_bound(begin, item) - begin.begin()) - 1;
}

TEST_P(SurfaceOf, HasEveryTriangleAsItIsInTheMesh) {
    std::set<int> seen;
    for (int t = 0; t < s_.triangle_count(); ++t) {
        const int in_mesh = s_.mesh_triangles[static_cast<std::size_t>(t)];
        EXPECT_TRUE(seen.insert(in_mesh).second);
        const auto& corners = s_.triangles[static_cast<std::size_t>(t)];
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(model(corners[k]),
                      mesh_.mesh.triangles[static_cast<std::size_t>(in_mesh)][k]);
        }
    }
    const auto is_good = [](const auto& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; };
    EXPECT_EQ(std::ssize(seen), std::ranges::count_if(mesh_.mesh.triangles, is_good));
}

TEST_P(SurfaceOf, HasEveryEdgeAndVertexOnce) {
    std::set<std::array<int, 2>> edges;
    std::set<int> vertices;
    for (const auto& t : s_.triangles) {
        vertices.insert(t.begin(), t.end());
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
            edges.insert({low, high});
        }
    }
    EXPECT_EQ(std::vector(edges.begin(), edges.end()), s_.edges);
    EXPECT_EQ(std::ssize(vertices), s_.vertex_count());
    EXPECT_EQ(std::set(s_.vertices.begin(), s_.vertices.end()).size(), s_.vertices.size());
}

TEST_P(SurfaceOf, PatchesAreOfOneBodyAndStripAndHaveTheirLowestVertices) {
    std::map<int, int> body;
    for (std::size_t t = 0; t < mesh_.mesh.triangles.size(); ++t) {
        for (const int v : mesh_.mesh.triangles[t]) body[v] = mesh_.mesh.triangle_body[t];
    }
    for (int v = 0; v < s_.vertex_count(); ++v) {
        const int patch = patch_of(s_.patch_vertices, v);
        EXPECT_EQ(strip_of_patch(patch), mesh_.strips.strip_of(model(v)));
        EXPECT_EQ(s_.patch_body[static_cast<std::size_t>(patch)], body[model(v)]);
    }
    for (int t = 0; t < s_.triangle_count(); ++t) {
        EXPECT_EQ(patch_of(s_.patch_triangles, t),
                  patch_of(s_.patch_vertices,
                           std::ranges::min(s_.triangles[static_cast<std::size_t>(t)])));
    }
    for (int e = 0; e < s_.edge_count(); ++e) {
        EXPECT_EQ(patch_of(s_.patch_edges, e),
                  patch_of(s_.patch_vertices, s_.edges[static_cast<std::size_t>(e)][0]));
    }
    for (int p = 0; p < s_.patch_count(); ++p) {
        const auto at = static_cast<std::size_t>(p);
        EXPECT_GE(s_.patch_vertices[at + 1] - s_.patch_vertices[at], 1);
        EXPECT_LE(s_.patch_vertices[at + 1] - s_.patch_vertices[at], Surface::kPatchVertices);
    }
}

TEST_P(SurfaceOf, WhatIsSharedHasOneOwner) {
    std::map<std::set<int>, int> owners;
    std::set<std::set<int>> features;
    for (int t = 0; t < s_.triangle_count(); ++t) {
        const auto& x = s_.triangles[static_cast<std::size_t>(t)];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::set<int> edge{x[(k + 1) % 3], x[(k + 2) % 3]};
            const std::set<int> corner{x[k]};
            features.insert({edge, corner});
            if (s_.owned[static_cast<std::size_t>(t)] >> k & 1) ++owners[edge];
            if (s_.owned[static_cast<std::size_t>(t)] >> (3 + k) & 1) ++owners[corner];
            const int beyond = s_.beyond[static_cast<std::size_t>(t)][k];
            const auto has = [&](const auto& y) {
                return std::ranges::all_of(
                    edge, [&](int v) { return std::ranges::find(y, v) != y.end(); });
            };
            const bool alone = std::ranges::count_if(s_.triangles, has) == 1;
            EXPECT_EQ(beyond < 0, alone);
        }
    }
    EXPECT_EQ(owners.size(), features.size());
    for (const auto& [feature, count] : owners) EXPECT_EQ(count, 1);
}

/// So that what is said of the faces of a patch is said of all that it has.
TEST_P(SurfaceOf, FacesOfAPatchCoverItsVerticesAndEdges) {
    for (int p = 0; p < s_.patch_count(); ++p) {
        const auto at = static_cast<std::size_t>(p);
        const auto is_covered = [&](const auto& corners) {
            return std::ranges::any_of(s_.faces[p], [&](int t) {
                const auto& x = s_.triangles[static_cast<std::size_t>(t)];
                return std::ranges::all_of(
                    corners, [&](int v) { return std::ranges::find(x, v) != x.end(); });
            });
        };
        for (int v = s_.patch_vertices[at]; v < s_.patch_vertices[at + 1]; ++v) {
            EXPECT_TRUE(is_covered(std::array{v}));
        }
        for (int e = s_.patch_edges[at]; e < s_.patch_edges[at + 1]; ++e) {
            EXPECT_TRUE(is_covered(s_.edges[static_cast<std::size_t>(e)]));
        }
        for (int t = s_.patch_triangles[at]; t < s_.patch_triangles[at + 1]; ++t) {
            EXPECT_TRUE(is_covered(s_.triangles[static_cast<std::size_t>(t)]));
        }
    }
}

void SurfaceOf::expect_without_slits(const PatchGroups& groups,
                                     const std::vector<int>& begin) const {
    const auto faces = [&](int g) {
        std::vector<std::array<int, 3>> all;
        for (int p = begin[static_cast<std::size_t>(g)]; p < begin[static_cast<std::size_t>(g) + 1];
             ++p) {
            EXPECT_EQ(groups.of_patch[static_cast<std::size_t>(p)], g);
            for (const int t : s_.faces[p]) {
                all.push_back(s_.triangles[static_cast<std::size_t>(t)]);
            }
        }
        return all;
    };
    const auto is_at_border = [&](int g) {
        return std::ranges::any_of(faces(g), [&](const auto& x) {
            const auto t = std::ranges::find(s_.triangles, x) - s_.triangles.begin();
            return std::ranges::min(s_.beyond[static_cast<std::size_t>(t)]) < 0;
        });
    };
    const auto turn = [&](int g) {
        const auto from = s_.turns.begin();
        return std::accumulate(from + begin[static_cast<std::size_t>(g)],
                               from + begin[static_cast<std::size_t>(g) + 1], 0.0);
    };
    constexpr double kMostTurn = std::numbers::pi / 3.0;
    const auto vertices = [&](int g) {
        std::set<int> all;
        for (const auto& x : faces(g)) all.insert(x.begin(), x.end());
        return all;
    };
    const auto touch = [&](int g, int h) {
        const std::set<int> other = vertices(h);
        return std::ranges::any_of(vertices(g), [&](int v) { return other.contains(v); });
    };
    const auto hull = [&](int g) {
        std::set<int> all;
        for (int p = begin[static_cast<std::size_t>(g)]; p < begin[static_cast<std::size_t>(g) + 1];
             ++p) {
            all.insert(s_.hulls[p].begin(), s_.hulls[p].end());
        }
        return all;
    };
    const auto share_a_hull = [&](int g, int h) {
        const std::set<int> other = hull(h);
        return std::ranges::any_of(hull(g), [&](int v) { return other.contains(v); });
    };
    const auto is_one_piece = [&](int g) {
        const auto all = faces(g);
        std::set<int> reached(all.front().begin(), all.front().end());
        for (std::size_t round = 0; round < all.size(); ++round) {
            for (const auto& x : all) {
                if (std::ranges::any_of(x, [&](int v) { return reached.contains(v); })) {
                    reached.insert(x.begin(), x.end());
                }
            }
        }
        return reached == vertices(g);
    };
    ASSERT_EQ(groups.beside.count(), static_cast<int>(begin.size()) - 1);
    for (int g = 0; g < groups.beside.count(); ++g) {
        const auto list = groups.beside[g];
        EXPECT_TRUE(std::ranges::is_sorted(list));
        EXPECT_TRUE(list.empty() || is_one_piece(g)) << g;
        EXPECT_EQ(std::ranges::find(list, g) != list.end(),
                  is_one_piece(g) && (!is_at_border(g) || turn(g) <= kMostTurn));
        for (std::size_t k = 0; k < list.size(); ++k) {
            const int via = groups.between[static_cast<std::size_t>(
                                               groups.beside.begin[static_cast<std::size_t>(g)]) +
                                           k];
            const int h = list[k];
            const bool is_direct = via == g || via == h;
            const bool are_inside =
                (!is_at_border(g) || !is_at_border(h)) && (is_direct || !is_at_border(via));
            const double turns = turn(g) + (h == g ? 0.0 : turn(h)) + (is_direct ? 0.0 : turn(via));
            EXPECT_TRUE(are_inside || turns <= kMostTurn) << g << " and " << h << " by " << via;
            EXPECT_TRUE(touch(g, via) && touch(via, h));
            const auto back = groups.beside[h];
            const auto same = std::ranges::find(back, g);
            ASSERT_NE(same, back.end()) << g << " and " << h;
            const auto entry = groups.beside.begin[static_cast<std::size_t>(h)] +
                               static_cast<int>(same - back.begin());
            EXPECT_EQ(groups.between[static_cast<std::size_t>(entry)], via);
        }
        for (int h = 0; h < groups.beside.count(); ++h) {
            if (!share_a_hull(g, h) || !is_one_piece(g) || !is_one_piece(h)) continue;
            const bool is_slit = is_at_border(g) && is_at_border(h) &&
                                 turn(g) + (h == g ? 0.0 : turn(h)) > kMostTurn;
            const auto found = std::ranges::find(list, h);
            if (!is_slit) {
                ASSERT_NE(found, list.end()) << g << " and " << h;
                const int via = groups.between[static_cast<std::size_t>(
                    groups.beside.begin[static_cast<std::size_t>(g)] + (found - list.begin()))];
                EXPECT_TRUE(via == g || via == h) << g << " and " << h << " by " << via;
            }
        }
    }
}

/// Groups of some patches each, and what is said of them.
TEST_P(SurfaceOf, GroupsThatHangTogetherAreOnePieceEachWithoutASlit) {
    for (const int patches : {1, 3}) {
        std::vector<int> begin{0};
        while (begin.back() < s_.patch_count()) {
            begin.push_back(std::min(begin.back() + patches, s_.patch_count()));
        }
        expect_without_slits(find_groups(s_, begin), begin);
    }
}

std::string name_of_mesh(const testing::TestParamInfo<std::size_t>& info) {
    std::string name = contact_meshes()[info.param].name;
    std::ranges::replace(name, ' ', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Meshes, SurfaceOf, testing::Range(std::size_t{0}, contact_meshes().size()),
                         name_of_mesh);

}  // namespace
}  // namespace weft::test
