#include "simulation/topology/adjacency.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "scheduler/assert.h"

namespace weft {
namespace {

/// One side of a triangle, filed under the lower of its vertices.
struct Side {
    int high;      ///< the edge's higher vertex
    int backward;  ///< 1 if the triangle runs from high to low
    int triangle;
    int opposite;

    auto order() const { return std::pair(high, triangle); }
};

bool is_degenerate(std::span<const int> triangle) {
    return triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
}

template <class Visit>
void for_each_side(std::span<const int> triangles, Visit visit) {
    for (std::size_t first = 0; first + 2 < triangles.size(); first += 3) {
        const std::span<const int> corners = triangles.subspan(first, 3);
        if (is_degenerate(corners)) continue;
        for (std::size_t i = 0; i < 3; ++i) {
            const int from = corners[i], to = corners[(i + 1) % 3], opposite = corners[(i + 2) % 3];
            visit(std::min(from, to),
                  Side{std::max(from, to), from > to, static_cast<int>(first / 3), opposite});
        }
    }
}

/// All sides, bucketed by low vertex: those of vertex v are [begin[v], begin[v + 1]), sorted.
struct Sides {
    std::vector<int> begin;
    std::vector<Side> sides;
};

Sides collect_sides(int vertex_count, std::span<const int> triangles) {
    Sides result;
    // Filed through begin[low + 1], which so ends up as the bucket's end: the next one's begin.
    result.begin.assign(static_cast<std::size_t>(vertex_count) + 2, 0);
    int count = 0;
    for_each_side(triangles, [&](int low, [[maybe_unused]] const Side& side) {
        WEFT_ASSERT(low >= 0 && side.high < vertex_count);
        ++result.begin[low + 2];
        ++count;
    });
    std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());
    result.sides.resize(static_cast<std::size_t>(count));
    for_each_side(triangles,
                  [&](int low, const Side& side) { result.sides[result.begin[low + 1]++] = side; });
    for (int v = 0; v < vertex_count; ++v) {
        std::sort(result.sides.begin() + result.begin[v],
                  result.sides.begin() + result.begin[v + 1],
                  [](const Side& a, const Side& b) { return a.order() < b.order(); });
    }
    return result;
}

void append_hinge(int low, const Side& first, const Side& second, Stencils& hinges) {
    if (first.opposite == second.opposite) return;
    const bool swapped = first.backward != 0 && second.backward == 0;
    const Side& forward = swapped ? second : first;
    const Side& backward = swapped ? first : second;
    hinges.vertices.insert(hinges.vertices.end(),
                           {low, first.high, forward.opposite, backward.opposite});
}

}  // namespace

Adjacency find_adjacency(int vertex_count, std::span<const int> triangles) {
    WEFT_ASSERT(triangles.size() % 3 == 0);
    const auto [begin, sides] = collect_sides(vertex_count, triangles);
    Adjacency result{.edges = {.arity = 2, .vertices = {}}, .hinges = {.arity = 4, .vertices = {}}};
    result.edges.vertices.reserve(sides.size() + sides.size() / 8);
    result.hinges.vertices.reserve(sides.size() * 2);
    for (int low = 0; low < vertex_count; ++low) {
        for (int i = begin[low], next = i; i < begin[low + 1]; i = next) {
            while (next < begin[low + 1] && sides[next].high == sides[i].high) ++next;
            result.edges.vertices.insert(result.edges.vertices.end(), {low, sides[i].high});
            if (next - i == 2) append_hinge(low, sides[i], sides[i + 1], result.hinges);
        }
    }
    return result;
}

}  // namespace weft
