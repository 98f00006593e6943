#include "simulation/mesh/mesh_checks.h"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/error.h"

namespace weft {
namespace {

// Height over longest edge. Single precision places a vertex to about 1e-7 of the distances here.
constexpr double kFlattest = 1e-7;

Vec3 rounded(Vec3 p) {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// Items grouped by one vertex each: those of vertex v are items[begin[v]] .. items[begin[v + 1]].
template <class Item>
struct Buckets {
    std::vector<std::size_t> begin;
    std::vector<Item> items;
};

/// Counting sort of what `visit` hands out; `visit(f)` calls f(vertex, item) for each, twice over.
template <class Item, class Visit>
Buckets<Item> group_by_vertex(int vertex_count, Visit visit) {
    Buckets<Item> buckets;
    buckets.begin.assign(static_cast<std::size_t>(vertex_count) + 1, 0);
    visit([&](int vertex, const Item&) { ++buckets.begin[vertex + 1]; });
    for (std::size_t v = 1; v < buckets.begin.size(); ++v) buckets.begin[v] += buckets.begin[v - 1];
    buckets.items.resize(buckets.begin.back());
    std::vector<std::size_t> next(buckets.begin.begin(), buckets.begin.end() - 1);
    visit([&](int vertex, const Item& item) { buckets.items[next[vertex]++] = item; });
    return buckets;
}

/// The triangle's other two vertices by their lowest one, and which triangle it was.
struct Corner {
    int middle = 0;
    int high = 0;
    int triangle = 0;
    friend auto operator<=>(const Corner&, const Corner&) = default;
};

/// Indices of triangles that repeat an earlier one, ascending.
std::vector<int> repeated_triangles(const TriangleMesh& mesh) {
    auto corners = group_by_vertex<Corner>(mesh.vertex_count(), [&](auto add) {
        for (int t = 0; t < mesh.triangle_count(); ++t) {
            std::array<int, 3> v = mesh.triangles[t];
            std::sort(v.begin(), v.end());
            add(v[0], Corner{v[1], v[2], t});
        }
    });
    std::vector<int> repeated;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const auto first = corners.items.begin() + static_cast<std::ptrdiff_t>(corners.begin[v]);
        const auto last = corners.items.begin() + static_cast<std::ptrdiff_t>(corners.begin[v + 1]);
        std::sort(first, last);
        for (auto c = first; c != last; ++c) {
            const bool same =
                c != first && (c - 1)->middle == c->middle && (c - 1)->high == c->high;
            if (same) repeated.push_back(c->triangle);
        }
    }
    std::sort(repeated.begin(), repeated.end());
    return repeated;
}

struct CrowdedEdges {
    std::size_t count = 0;
    std::array<int, 2> first{};
};

/// Edges that more than two triangles share.
CrowdedEdges crowded_edges(const TriangleMesh& mesh) {
    auto edges = group_by_vertex<int>(mesh.vertex_count(), [&](auto add) {
        for (const std::array<int, 3>& v : mesh.triangles) {
            for (int i = 0; i < 3; ++i) {
                add(std::min(v[i], v[(i + 1) % 3]), std::max(v[i], v[(i + 1) % 3]));
            }
        }
    });
    CrowdedEdges crowded;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const auto first = edges.items.begin() + static_cast<std::ptrdiff_t>(edges.begin[v]);
        const auto last = edges.items.begin() + static_cast<std::ptrdiff_t>(edges.begin[v + 1]);
        std::sort(first, last);
        for (auto edge = first; edge != last;) {
            const auto next = std::find_if(edge, last, [&](int other) { return other != *edge; });
            if (next - edge > 2 && crowded.count++ == 0) crowded.first = {v, *edge};
            edge = next;
        }
    }
    return crowded;
}

bool spans_area(Vec3 ab, Vec3 ac) {
    const double longest = std::max({dot(ab, ab), dot(ac, ac), dot(ac - ab, ac - ab)});
    return length(cross(ab, ac)) > kFlattest * longest;
}

}  // namespace

void check_areas(const TriangleMesh& mesh) {
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 p = rounded(mesh.positions[a]);
        const Vec3 ab = rounded(mesh.positions[b]) - p;
        const Vec3 ac = rounded(mesh.positions[c]) - p;
        if (spans_area(ab, ac)) continue;
        throw UserError(fmt::format(
            "{}: degenerate triangle over the vertices {}, {}, {} (counted from 1): it has no area "
            "in single precision; its first corner is at ({}, {}, {})",
            mesh.source, mesh.number_in_file(a) + 1, mesh.number_in_file(b) + 1,
            mesh.number_in_file(c) + 1, p.x, p.y, p.z));
    }
    for (std::size_t t = 0; t < mesh.rest.size(); ++t) {
        const auto& [a, b, c] = mesh.rest[t];
        if (spans_area(rounded(b) - rounded(a), rounded(c) - rounded(a))) continue;
        throw UserError(
            fmt::format("{}: degenerate triangle {} (counted from 1): it has no area in single "
                        "precision; its first corner is at ({}, {}, {})",
                        mesh.rest_source, t + 1, a.x, a.y, a.z));
    }
}

void drop_duplicates(TriangleMesh& mesh, Warnings& warnings) {
    const std::vector<int> repeated = repeated_triangles(mesh);
    if (repeated.empty()) return;
    warnings.push_back(
        fmt::format("{}: {} triangles repeat another one and are dropped, the first "
                    "is triangle {} (counted from 1)",
                    mesh.source, repeated.size(), repeated.front() + 1));
    std::vector<std::array<int, 3>> kept;
    std::vector<std::array<std::array<double, 2>, 3>> texture;
    std::vector<std::array<Vec3, 3>> kept_rest;
    std::vector<MeshPart> parts;
    auto skip = repeated.begin();
    for (const MeshPart& part : mesh.parts) {
        const int begin = static_cast<int>(kept.size());
        for (int t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
            if (skip != repeated.end() && *skip == t) {
                ++skip;
                continue;
            }
            kept.push_back(mesh.triangles[t]);
            if (!mesh.texture.empty()) texture.push_back(mesh.texture[t]);
            if (!mesh.rest.empty()) kept_rest.push_back(mesh.rest[static_cast<std::size_t>(t)]);
        }
        const int count = static_cast<int>(kept.size()) - begin;
        if (count > 0) parts.push_back({part.name, begin, count, part.object});
    }
    mesh.triangles = std::move(kept);
    mesh.texture = std::move(texture);
    mesh.rest = std::move(kept_rest);
    mesh.parts = std::move(parts);
}

void warn_of_odd_topology(const TriangleMesh& mesh, Warnings& warnings) {
    const CrowdedEdges crowded = crowded_edges(mesh);
    if (crowded.count > 0) {
        warnings.push_back(
            fmt::format("{}: {} edges have more than two triangles and get no "
                        "bending, the first joins the vertices {} and {} (counted "
                        "from 1)",
                        mesh.source, crowded.count, mesh.number_in_file(crowded.first[0]) + 1,
                        mesh.number_in_file(crowded.first[1]) + 1));
    }
    std::vector<char> used(mesh.positions.size(), 0);
    for (const auto& triangle : mesh.triangles) {
        for (const int v : triangle) used[v] = 1;
    }
    const auto lonely = std::count(used.begin(), used.end(), 0);
    if (lonely == 0) return;
    const auto first = std::find(used.begin(), used.end(), 0) - used.begin();
    warnings.push_back(
        fmt::format("{}: {} vertices belong to no triangle and stay where they are, "
                    "the first is vertex {} (counted from 1)",
                    mesh.source, lonely, mesh.number_in_file(static_cast<int>(first)) + 1));
}

}  // namespace weft
