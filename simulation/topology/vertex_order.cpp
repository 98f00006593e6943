#include "simulation/topology/vertex_order.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "scheduler/assert.h"

namespace weft {
namespace {

using Link = std::array<int, 2>;

/// Union-find; the root is the lowest vertex.
class Components {
public:
    explicit Components(int vertex_count) : parent_(static_cast<std::size_t>(vertex_count)) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }

    int find(int v) {
        while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
        return v;
    }

    void unite(int a, int b) {
        const auto [low, high] = std::minmax({find(a), find(b)});
        parent_[high] = low;
    }

    bool connects(std::span<const int> vertices) {
        const int root = find(vertices[0]);
        return std::ranges::all_of(vertices, [&](int v) { return find(v) == root; });
    }

private:
    std::vector<int> parent_;
};

/// Links between all pairs of vertices of those elements that are not yet connected.
void append_links(const Stencils& kind, Components& components, std::vector<Link>& links) {
    const std::size_t old_count = links.size();
    for (int e = 0; e < kind.count(); ++e) {
        const std::span<const int> vertices = kind[e];
        if (components.connects(vertices)) continue;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            for (std::size_t j = i + 1; j < vertices.size(); ++j) {
                links.push_back({vertices[i], vertices[j]});
            }
        }
    }
    // Only now: whether an element counts must not depend on its place among its own kind.
    for (const auto& [a, b] : std::span(links).subspan(old_count)) components.unite(a, b);
}

std::vector<Link> collect_links(int vertex_count, std::span<const Stencils> kinds) {
    std::vector<const Stencils*> by_arity;
    for (const Stencils& kind : kinds) by_arity.push_back(&kind);
    std::ranges::stable_sort(by_arity, {}, [](const Stencils* kind) { return kind->arity; });

    Components components(vertex_count);
    std::vector<Link> links;
    for (const Stencils* kind : by_arity) append_links(*kind, components, links);
    return links;
}

/// Neighbours of vertex v: neighbour[begin[v] .. begin[v + 1]); some more than once.
struct Graph {
    std::vector<int> begin;
    std::vector<int> neighbour;

    int degree(int v) const { return begin[v + 1] - begin[v]; }
};

Graph make_graph(int vertex_count, const std::vector<Link>& links) {
    Graph graph;
    graph.begin.assign(static_cast<std::size_t>(vertex_count) + 2, 0);
    graph.neighbour.resize(links.size() * 2);
    for (const auto& [a, b] : links) {
        ++graph.begin[a + 2];
        ++graph.begin[b + 2];
    }
    std::partial_sum(graph.begin.begin(), graph.begin.end(), graph.begin.begin());
    for (const auto& [a, b] : links) {
        graph.neighbour[graph.begin[a + 1]++] = b;
        graph.neighbour[graph.begin[b + 1]++] = a;
    }
    return graph;
}

/// One component by breadth-first levels.
struct Levels {
    std::vector<int> order;
    std::vector<int> begin;  ///< where each level begins in `order`

    int count() const { return static_cast<int>(begin.size()); }
};

class Searcher {
public:
    explicit Searcher(const Graph& graph) : graph_(graph), seen_(graph.begin.size(), 0) {}

    bool has_seen(int v) const { return seen_[v] != 0; }

    /// Fills `levels` with the component of `root`.
    void search(int root, Levels& levels) {
        ++stamp_;
        levels.order.assign(1, root);
        levels.begin.clear();
        seen_[root] = stamp_;
        for (std::size_t first = 0; first < levels.order.size();) {
            levels.begin.push_back(static_cast<int>(first));
            const std::size_t last = levels.order.size();
            for (; first < last; ++first) append_neighbours(levels.order[first], levels.order);
        }
    }

private:
    /// Those that this search has not met.
    void append_neighbours(int v, std::vector<int>& order) {
        for (int i = graph_.begin[v]; i < graph_.begin[v + 1]; ++i) {
            const int other = graph_.neighbour[i];
            if (seen_[other] == stamp_) continue;
            seen_[other] = stamp_;
            order.push_back(other);
        }
    }

    const Graph& graph_;
    std::vector<int> seen_;  ///< number of the last search that met the vertex
    int stamp_ = 0;
};

/// A vertex of the last level with few neighbours: likely to see even more levels.
int far_end(const Graph& graph, const Levels& levels) {
    return *std::min_element(
        levels.order.begin() + levels.begin.back(), levels.order.end(), [&](int a, int b) {
            return std::pair(graph.degree(a), a) < std::pair(graph.degree(b), b);
        });
}

/// Searches from far end to far end while that gives more levels.
void search_from_far_end(const Graph& graph, int root, Searcher& searcher, Levels& best,
                         Levels& next) {
    constexpr int kMaxSearches = 8;
    searcher.search(root, best);
    for (int i = 1; i < kMaxSearches && best.order.size() > 1; ++i) {
        searcher.search(far_end(graph, best), next);
        if (next.count() <= best.count()) return;
        std::swap(best, next);
    }
}

}  // namespace

VertexOrder order_vertices(int vertex_count, std::span<const Stencils> kinds) {
    const Graph graph = make_graph(vertex_count, collect_links(vertex_count, kinds));
    Searcher searcher(graph);
    VertexOrder result;
    result.order.reserve(static_cast<std::size_t>(vertex_count));
    Levels best, next;
    for (int v = 0; v < vertex_count; ++v) {
        if (searcher.has_seen(v)) continue;
        search_from_far_end(graph, v, searcher, best, next);
        const int base = static_cast<int>(result.order.size());
        for (int begin : best.begin) result.level_begin.push_back(base + begin);
        result.order.insert(result.order.end(), best.order.begin(), best.order.end());
    }
    result.level_begin.push_back(vertex_count);
    WEFT_ASSERT(std::ssize(result.order) == vertex_count);
    WEFT_ASSERT(std::ranges::is_sorted(result.level_begin));
    return result;
}

}  // namespace weft
