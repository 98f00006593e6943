#include "simulation/mesh/weld.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "runtime/error.h"
#include "simulation/mesh/border.h"
#include "simulation/mesh/vertex_sets.h"

namespace weft {
namespace {

constexpr double kReach = 0.01;  // of the shortest edge

std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::array<int, 3> sorted(std::array<int, 3> corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
}

/// What the vertices become: numbers without gaps, in the order of the least of each set.
std::vector<int> new_numbers(int vertices, std::span<const std::array<int, 2>> pairs) {
    VertexSets sets(vertices);
    for (const auto& [a, b] : pairs) sets.unite(a, b);
    std::vector<int> numbers(at(vertices));
    int next = 0;
    for (int v = 0; v < vertices; ++v) {
        const int least = sets.least(v);
        numbers[at(v)] = least == v ? next++ : numbers[at(least)];
    }
    return numbers;
}

/// A triangle and what its corners become.
struct Renumbered {
    std::array<int, 3> corners;  ///< ascending
    std::size_t triangle;
    friend auto operator<=>(const Renumbered&, const Renumbered&) = default;
};

void check_triangles(const TriangleMesh& mesh, const std::vector<int>& numbers,
                     const std::string& where) {
    std::vector<Renumbered> all;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const std::array corners = sorted({numbers[at(a)], numbers[at(b)], numbers[at(c)]});
        if (corners[0] == corners[1] || corners[1] == corners[2]) {
            throw UserError(
                fmt::format("{}: the triangle over the vertices {} (counted from 0) would have two "
                            "corners in one, and no area",
                            where, fmt::join(mesh.triangles[t], ", ")));
        }
        all.push_back({corners, t});
    }
    std::sort(all.begin(), all.end());
    const auto same = std::ranges::adjacent_find(all, {}, &Renumbered::corners);
    if (same == all.end()) return;
    throw UserError(fmt::format(
        "{}: the triangles over the vertices {} and {} (counted from 0) would have the same "
        "corners: they lie upon each other, and only two of these may become one each",
        where, fmt::join(mesh.triangles[same->triangle], ", "),
        fmt::join(mesh.triangles[(same + 1)->triangle], ", ")));
}

}  // namespace

std::vector<double> weld_reach(const TriangleMesh& mesh) {
    std::vector<double> reach(mesh.positions.size(), std::numeric_limits<double>::infinity());
    for (const auto& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = at(t[k]), b = at(t[(k + 1) % 3]);
            const double part = kReach * length(mesh.positions[a] - mesh.positions[b]);
            reach[a] = std::min(reach[a], part);
            reach[b] = std::min(reach[b], part);
        }
    }
    std::ranges::replace(reach, std::numeric_limits<double>::infinity(), 0.0);
    return reach;
}

std::vector<std::array<int, 2>> coincident_border(const TriangleMesh& mesh,
                                                  std::span<const double> reach) {
    std::vector<int> border;
    for (const BorderChain& chain :
         border_chains(mesh, std::vector<char>(mesh.positions.size(), 1))) {
        border.insert(border.end(), chain.vertices.begin(), chain.vertices.end());
    }
    const auto x = [&](int v) { return mesh.positions[at(v)].x; };
    std::ranges::sort(border,
                      [&](int a, int b) { return std::pair(x(a), a) < std::pair(x(b), b); });
    std::vector<std::array<int, 2>> pairs;
    for (auto a = border.begin(); a != border.end(); ++a) {
        const double near = reach[at(*a)];
        for (auto b = a + 1; b != border.end() && x(*b) - x(*a) <= near; ++b) {
            const double apart = length(mesh.positions[at(*a)] - mesh.positions[at(*b)]);
            if (*a != *b && apart <= std::min(near, reach[at(*b)])) pairs.push_back({*a, *b});
        }
    }
    return pairs;
}

void weld(TriangleMesh& mesh, std::span<const std::array<int, 2>> pairs, const std::string& where) {
    std::vector<int> numbers = new_numbers(mesh.vertex_count(), pairs);
    check_triangles(mesh, numbers, where);
    std::size_t count = 0;
    for (std::size_t v = 0; v < numbers.size(); ++v) {
        // The first vertex of each number, in the order of the numbers.
        if (at(numbers[v]) == count) mesh.positions[count++] = mesh.positions[v];
    }
    mesh.positions.resize(count);
    for (auto& t : mesh.triangles) {
        for (int& v : t) v = numbers[at(v)];
    }
    mesh.welded = std::move(numbers);
}

}  // namespace weft
