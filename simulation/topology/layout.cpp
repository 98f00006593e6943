#include "simulation/topology/layout.h"

#include <algorithm>
#include <numeric>

#include "runtime/unused_memory.h"
#include "scheduler/assert.h"
#include "simulation/topology/colouring.h"

namespace weft {
namespace {

struct Place {
    int strip;
    int phase;
};

/// The kind's elements in new vertices, in their old order.
Stencils rename_vertices(const Stencils& kind, const std::vector<int>& rank) {
    Stencils result = kind;
    for (int& v : result.vertices) v = rank[v];
    return result;
}

/// Elements by lowest vertex, those of equal lowest vertex in their old order.
std::vector<int> sort_by_lowest_vertex(const Stencils& kind, int vertex_count) {
    std::vector<int> next(static_cast<std::size_t>(vertex_count) + 1, 0);
    for (int e = 0; e < kind.count(); ++e) ++next[std::ranges::min(kind[e]) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    std::vector<int> order(static_cast<std::size_t>(kind.count()));
    for (int e = 0; e < kind.count(); ++e) order[next[std::ranges::min(kind[e])]++] = e;
    return order;
}

Stencils reorder(const Stencils& kind, const std::vector<int>& order) {
    Stencils result{.arity = kind.arity, .vertices = {}};
    result.vertices.reserve(kind.vertices.size());
    for (int e : order) {
        for (int v : kind[e]) result.vertices.push_back(v);
    }
    return result;
}

std::vector<Place> find_places(const Stencils& kind, const Strips& strips) {
    std::vector<int> strip_of(strips.order.size());
    for (int s = 0; s < strips.count(); ++s) {
        std::fill(strip_of.begin() + strips.begin[s], strip_of.begin() + strips.begin[s + 1], s);
    }
    std::vector<Place> places(static_cast<std::size_t>(kind.count()));
    for (int e = 0; e < kind.count(); ++e) {
        const auto [low, high] = std::ranges::minmax(kind[e]);
        WEFT_ASSERT(strip_of[high] - strip_of[low] <= 1);
        places[e] = {strip_of[low], strip_of[low] == strip_of[high] ? kInnerPhase : kSeamPhase};
    }
    return places;
}

/// The elements of one phase, strip by strip: `elements` are by lowest vertex.
using Groups = std::vector<std::span<const int>>;

Groups split_by_strip(std::span<const int> elements, const std::vector<Place>& places) {
    Groups groups;
    for (std::size_t first = 0, last = 0; first < elements.size(); first = last) {
        const int strip = places[elements[first]].strip;
        while (last < elements.size() && places[elements[last]].strip == strip) ++last;
        groups.push_back(elements.subspan(first, last - first));
    }
    return groups;
}

/// Colours each strip for itself. The goal is what some strip needs anyway: with fewer colours
/// elsewhere, the phase would not have fewer.
int colour_phase(const Groups& groups, Colourer& colourer, std::span<int> colour) {
    int count = 0;
    for (const auto& group : groups) count = std::max(count, colourer.lower_bound(group));
    for (const auto& group : groups) {
        count = std::max(count, colourer.colour_group(group, count, colour));
    }
    return count;
}

std::vector<int> elements_of_phase(const std::vector<Place>& places, int phase) {
    std::vector<int> elements;
    for (std::size_t e = 0; e < places.size(); ++e) {
        if (places[e].phase == phase) elements.push_back(static_cast<int>(e));
    }
    return elements;
}

/// Fills the layout's segment table and returns the elements by segment, in their old order within.
std::vector<int> sort_into_segments(const std::vector<Place>& places, std::span<const int> colour,
                                    ElementLayout& layout) {
    const int element_count = static_cast<int>(places.size());
    const auto segment_of = [&](int e) {
        return layout.segment(places[e].phase, colour[e], places[e].strip);
    };
    std::vector<int>& begin = layout.segment_begin;
    begin.assign(static_cast<std::size_t>(layout.segment_count()) + 1, 0);
    for (int e = 0; e < element_count; ++e) ++begin[segment_of(e) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<int> next = begin;
    std::vector<int> order(places.size());
    for (int e = 0; e < element_count; ++e) order[next[segment_of(e)]++] = e;
    return order;
}

}  // namespace

ElementLayout make_layout(const Stencils& kind, const Strips& strips) {
    const int vertex_count = static_cast<int>(strips.rank.size());
    Stencils renamed = rename_vertices(kind, strips.rank);
    const std::vector<int> by_vertex = sort_by_lowest_vertex(renamed, vertex_count);
    const Stencils sorted = reorder(renamed, by_vertex);
    give_back(renamed.vertices);
    const std::vector<Place> places = find_places(sorted, strips);

    ElementLayout layout;
    layout.strip_count = strips.count();
    Colourer colourer(sorted, vertex_count);
    std::vector<int> colour(places.size());
    for (int phase = 0; phase < kPhaseCount; ++phase) {
        const std::vector<int> elements = elements_of_phase(places, phase);
        const Groups groups = split_by_strip(elements, places);
        layout.colour_count[phase] = colour_phase(groups, colourer, colour);
    }
    layout.order = sort_into_segments(places, colour, layout);
    layout.stencils = reorder(sorted, layout.order);
    for (int& e : layout.order) e = by_vertex[e];
    WEFT_ASSERT(std::ranges::is_sorted(layout.segment_begin));
    WEFT_ASSERT(layout.segment_begin.back() == kind.count());
    return layout;
}

}  // namespace weft
