#include "simulation/mesh/border.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace weft {
namespace {

using Edge = std::pair<int, int>;

/// Directed edges of one triangle alone, both ends selected.
std::vector<Edge> border_edges(const TriangleMesh& mesh, std::span<const char> selected) {
    const auto is_selected = [&](int v) { return selected[static_cast<std::size_t>(v)] != 0; };
    std::vector<std::array<int, 3>> sides;  // low, high, 1: runs from high to low
    for (const auto& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const int from = t[k], to = t[(k + 1) % 3];
            if (!is_selected(from) || !is_selected(to)) continue;
            sides.push_back({std::min(from, to), std::max(from, to), from > to ? 1 : 0});
        }
    }
    std::sort(sides.begin(), sides.end());
    std::vector<Edge> edges;
    const auto same = [&](std::size_t i, std::size_t j) {
        return j < sides.size() && sides[i][0] == sides[j][0] && sides[i][1] == sides[j][1];
    };
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (same(i, i + 1) || (i > 0 && same(i, i - 1))) continue;
        const auto [low, high, is_backward] = sides[i];
        edges.push_back(is_backward ? Edge(high, low) : Edge(low, high));
    }
    return edges;
}

/// Takes edges out of `next` from this vertex on, for as long as there are any.
BorderChain walk(std::multimap<int, int>& next, int first) {
    BorderChain chain{{first}, false};
    for (auto edge = next.find(first); edge != next.end();) {
        const int to = edge->second;
        next.erase(edge);
        chain.is_closed = to == first;
        if (chain.is_closed) break;
        chain.vertices.push_back(to);
        edge = next.find(to);
    }
    return chain;
}

}  // namespace

std::vector<BorderChain> border_chains(const TriangleMesh& mesh, std::span<const char> selected) {
    std::multimap<int, int> next;
    std::map<int, int> incoming;
    for (const auto& [from, to] : border_edges(mesh, selected)) {
        next.emplace(from, to);
        ++incoming[to];
    }
    std::vector<int> starts;
    for (const auto& [from, to] : next) {
        if (!incoming.contains(from)) starts.push_back(from);
    }
    std::vector<BorderChain> chains;
    for (const int start : starts) chains.push_back(walk(next, start));
    while (!next.empty()) chains.push_back(walk(next, next.begin()->first));  // loops are left
    return chains;
}

}  // namespace weft
