#include "simulation/mesh/tet_checks.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "runtime/error.h"

namespace weft {
namespace {

// Six volumes over the cube of the longest edge: 0.7 for a regular tetrahedron, and about 1e-3 for
// a poor one. Single precision places a vertex to about 1e-7 of the distances here.
constexpr double kFlattest = 1e-6;

Vec3 rounded(Vec3 p) {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// Of sorted items, how many come more than `most` times, and the first of these.
template <class Item>
std::pair<std::size_t, Item> crowded(const std::vector<Item>& items, std::ptrdiff_t most) {
    std::pair<std::size_t, Item> result{};
    for (auto first = items.begin(); first != items.end();) {
        const auto next = std::upper_bound(first, items.end(), *first);
        if (next - first > most && result.first++ == 0) result.second = *first;
        first = next;
    }
    return result;
}

}  // namespace

void turn_inverted(TetMesh& mesh, Warnings& warnings) {
    std::size_t count = 0;
    std::size_t first = 0;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        auto& tetrahedron = mesh.tetrahedra[t];
        if (six_volumes(mesh, tetrahedron) >= 0.0) continue;
        std::swap(tetrahedron[2], tetrahedron[3]);
        if (count++ == 0) first = t;
    }
    if (count == 0) return;
    warnings.push_back(
        fmt::format("{}: {} tetrahedra are inverted and get their last two vertices exchanged, the "
                    "first is tetrahedron {} (counted from 1)",
                    mesh.source, count, first + 1));
}

void drop_duplicates(TetMesh& mesh, Warnings& warnings) {
    std::vector<std::pair<std::array<int, 4>, std::size_t>> sorted;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        auto vertices = mesh.tetrahedra[t];
        std::sort(vertices.begin(), vertices.end());
        sorted.emplace_back(vertices, t);
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<char> repeated(sorted.size(), 0);
    for (std::size_t i = 1; i < sorted.size(); ++i) {
        if (sorted[i].first == sorted[i - 1].first) repeated[sorted[i].second] = 1;
    }
    const auto count = std::count(repeated.begin(), repeated.end(), 1);
    if (count == 0) return;
    const auto first = std::find(repeated.begin(), repeated.end(), 1) - repeated.begin();
    warnings.push_back(
        fmt::format("{}: {} tetrahedra repeat another one and are dropped, the "
                    "first is tetrahedron {} (counted from 1)",
                    mesh.source, count, first + 1));
    std::size_t next = 0;
    std::erase_if(mesh.tetrahedra, [&](const auto&) { return repeated[next++] != 0; });
}

void warn_of_odd_topology(const TetMesh& mesh, Warnings& warnings) {
    std::vector<std::array<int, 3>> faces;
    std::vector<char> used(mesh.positions.size(), 0);
    for (const auto& t : mesh.tetrahedra) {
        auto v = t;
        std::sort(v.begin(), v.end());
        faces.insert(
            faces.end(),
            {{v[0], v[1], v[2]}, {v[0], v[1], v[3]}, {v[0], v[2], v[3]}, {v[1], v[2], v[3]}});
        for (const int vertex : t) used[static_cast<std::size_t>(vertex)] = 1;
    }
    std::sort(faces.begin(), faces.end());
    if (const auto [count, face] = crowded(faces, 2); count > 0) {
        warnings.push_back(
            fmt::format("{}: {} faces have more than two tetrahedra, which overlap "
                        "there; the first joins the vertices {}, {}, {} (counted "
                        "from 1)",
                        mesh.source, count, face[0] + 1, face[1] + 1, face[2] + 1));
    }
    const auto lonely = std::count(used.begin(), used.end(), 0);
    if (lonely == 0) return;
    const auto first = std::find(used.begin(), used.end(), 0) - used.begin();
    warnings.push_back(
        fmt::format("{}: {} vertices belong to no tetrahedron and stay where they "
                    "are, the first is vertex {} (counted from 1)",
                    mesh.source, lonely, first + 1));
}

void check_volumes(const TetMesh& mesh) {
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        std::array<Vec3, 4> p;
        for (std::size_t k = 0; k < 4; ++k) {
            p[k] = rounded(mesh.positions[static_cast<std::size_t>(mesh.tetrahedra[t][k])]);
        }
        double longest = 0.0;
        for (std::size_t j = 0; j < 4; ++j) {
            for (std::size_t k = 0; k < j; ++k) longest = std::max(longest, length(p[j] - p[k]));
        }
        const double volume = dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]);
        if (volume > kFlattest * longest * longest * longest) continue;
        const auto& v = mesh.tetrahedra[t];
        throw UserError(fmt::format(
            "{}: degenerate tetrahedron {} over the vertices {}, {}, {}, {} (all counted from 1): "
            "it has no volume in single precision; its first corner is at ({}, {}, {})",
            mesh.source, t + 1, v[0] + 1, v[1] + 1, v[2] + 1, v[3] + 1, p[0].x, p[0].y, p[0].z));
    }
}

}  // namespace weft
