#include "simulation/topology/vertex_layout.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "simulation/topology/vertex_graph.h"

namespace weft {
namespace {

/// Where a vertex is computed: in a seam or inside a strip.
struct Place {
    int phase;
    int strip;

    bool operator==(const Place&) const = default;
};

std::vector<Place> find_places(const VertexGraph& graph, const Strips& strips) {
    std::vector<int> strip_of(static_cast<std::size_t>(graph.vertex_count()));
    for (int s = 0; s < strips.count(); ++s) {
        std::fill(strip_of.begin() + strips.begin[s], strip_of.begin() + strips.begin[s + 1], s);
    }
    std::vector<Place> places;
    for (int v = 0; v < graph.vertex_count(); ++v) {
        Place place{kInnerPhase, strip_of[v]};
        for (const int other : graph.neighbours(v)) {
            if (strip_of[other] == strip_of[v]) continue;
            place = {kSeamPhase, std::min(strip_of[other], strip_of[v])};
        }
        places.push_back(place);
    }
    return places;
}

/// partner[v]: the vertex that is computed together with v; v itself: none.
using Partners = std::vector<int>;

Partners no_partners(int vertex_count) {
    Partners partner(static_cast<std::size_t>(vertex_count));
    std::iota(partner.begin(), partner.end(), 0);
    return partner;
}

/// Colours the vertices of one place so that neighbours differ. Partners have one colour; groups
/// name the lower one of them.
class VertexColourer {
public:
    VertexColourer(const VertexGraph& graph, const std::vector<Place>& places,
                   const Partners& partner)
        : graph_(graph), places_(places), partner_(partner), colour_(places.size(), kNone) {}

    /// Returns the number of colours.
    int colour_group(std::span<const int> group) {
        int count = first_fit(group);
        // Iterated greedy (Culberson 1992): first fit, class by class from the last to the first,
        // never needs more colours, and often fewer.
        constexpr int kRounds = 8;
        std::vector<int> order(group.begin(), group.end());
        for (int round = 0; round < kRounds; ++round) {
            std::stable_sort(order.begin(), order.end(),
                             [&](int a, int b) { return colour_[a] > colour_[b]; });
            count = first_fit(order);
        }
        balance(group, count);
        return count;
    }
    int colour(int vertex) const { return colour_[vertex]; }

private:
    static constexpr int kNone = -1;

    /// Marks the colours of the neighbours, in the same place, of v and its partner.
    void find_taken(int v, int count) {
        taken_.assign(static_cast<std::size_t>(count) + 1, 0);
        for (const int corner : {v, partner_[v]}) {
            for (const int other : graph_.neighbours(corner)) {
                if (other == v || other == partner_[v] || !(places_[other] == places_[v])) continue;
                if (colour_[other] != kNone) taken_[colour_[other]] = 1;
            }
        }
    }

    void set_colour(int v, int colour) { colour_[v] = colour_[partner_[v]] = colour; }

    int first_fit(std::span<const int> order) {
        for (const int v : order) set_colour(v, kNone);
        int count = 0;
        for (const int v : order) {
            find_taken(v, count);
            const auto free = std::find(taken_.begin(), taken_.end(), 0);
            set_colour(v, static_cast<int>(free - taken_.begin()));
            count = std::max(count, colour_[v] + 1);
        }
        return count;
    }

    /// Moves vertices to the smallest colour that their neighbours allow: full packs of lanes.
    void balance(std::span<const int> group, int count) {
        std::vector<int> size(static_cast<std::size_t>(count), 0);
        for (const int v : group) ++size[colour_[v]];
        for (const int v : group) {
            find_taken(v, count);
            int best = colour_[v];
            for (int c = 0; c < count; ++c) {
                if (taken_[c] == 0 && size[c] + 1 < size[best]) best = c;
            }
            --size[colour_[v]];
            ++size[best];
            set_colour(v, best);
        }
    }

    const VertexGraph& graph_;
    const std::vector<Place>& places_;
    const Partners& partner_;
    std::vector<int> colour_;
    std::vector<char> taken_;
};

/// All vertices, those with a partner once, by segments that this fills in: the lower ones of
/// partners stand for both.
std::vector<int> sort_into_segments(const VertexGraph& graph, const Strips& strips,
                                    const std::vector<Place>& places, const Partners& partner,
                                    VertexLayout& layout) {
    const int vertex_count = graph.vertex_count();
    layout.strip_count = strips.count();
    std::vector<std::vector<int>> groups(static_cast<std::size_t>(kPhaseCount * strips.count()));
    for (int v = 0; v < vertex_count; ++v) {
        if (partner[v] < v) continue;
        groups[static_cast<std::size_t>(places[v].phase * strips.count() + places[v].strip)]
            .push_back(v);
    }
    VertexColourer colourer(graph, places, partner);
    for (int phase = 0; phase < kPhaseCount; ++phase) {
        int& most = layout.colour_count[static_cast<std::size_t>(phase)];
        for (int strip = 0; strip < strips.count(); ++strip) {
            const auto& group = groups[static_cast<std::size_t>(phase * strips.count() + strip)];
            most = std::max(most, colourer.colour_group(group));
        }
    }

    const auto segment_of = [&](int v) {
        return layout.segment(places[v].phase, colourer.colour(v), places[v].strip);
    };
    std::vector<int>& begin = layout.segment_begin;
    begin.assign(static_cast<std::size_t>(layout.segment_count()) + 1, 0);
    for (int v = 0; v < vertex_count; ++v) {
        if (partner[v] >= v) ++begin[segment_of(v) + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<int> next = begin;
    std::vector<int> sorted(static_cast<std::size_t>(begin.back()));
    for (int v = 0; v < vertex_count; ++v) {
        if (partner[v] >= v) sorted[next[segment_of(v)]++] = v;
    }
    return sorted;
}

}  // namespace

VertexLayout make_vertex_layout(std::span<const Stencils> kinds, const Strips& strips) {
    const VertexGraph graph(static_cast<int>(strips.order.size()), kinds);
    VertexLayout layout;
    layout.vertices = sort_into_segments(graph, strips, find_places(graph, strips),
                                         no_partners(graph.vertex_count()), layout);
    return layout;
}

StencilLayout make_stencil_layout(std::span<const Stencils> kinds, const Strips& strips,
                                  const Stencils& pairs, std::span<const int> order) {
    const VertexGraph graph(static_cast<int>(strips.order.size()), kinds);
    const std::vector<Place> places = find_places(graph, strips);
    Partners partner = no_partners(graph.vertex_count());
    std::vector<int> pair_of(partner.size(), -1);
    for (const int p : order) {
        const int a = pairs[p][0];
        const int b = pairs[p][1];
        if (partner[a] != a || partner[b] != b || !(places[a] == places[b])) continue;
        partner[a] = b;
        partner[b] = a;
        pair_of[std::min(a, b)] = p;
    }

    StencilLayout layout;
    const std::vector<int> sorted =
        sort_into_segments(graph, strips, places, partner, layout.items);
    layout.segment_begin = layout.items.segment_begin;
    for (int& begin : layout.items.segment_begin) begin *= 2;
    layout.items.vertices.resize(2 * sorted.size());
    for (std::size_t s = 0; s + 1 < layout.segment_begin.size(); ++s) {
        const int begin = layout.segment_begin[s];
        const int end = layout.segment_begin[s + 1];
        for (int i = begin; i < end; ++i) {
            const int first = begin + i;  // the segment's items begin at 2 begin
            const int second = end + i;
            layout.items.vertices[first] = sorted[i];
            layout.items.vertices[second] = partner[sorted[i]];
            layout.corners.push_back({first, second});
            layout.stencils.push_back(pair_of[sorted[i]]);
        }
    }
    return layout;
}

}  // namespace weft
