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

/// Colours the vertices of one place so that neighbours differ.
class VertexColourer {
public:
    VertexColourer(const VertexGraph& graph, const std::vector<Place>& places)
        : graph_(graph), places_(places), colour_(places.size(), kNone) {}

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

    /// Marks the colours of v's neighbours in the same place.
    void find_taken(int v, int count) {
        taken_.assign(static_cast<std::size_t>(count) + 1, 0);
        for (const int other : graph_.neighbours(v)) {
            if (places_[other] == places_[v] && colour_[other] != kNone) taken_[colour_[other]] = 1;
        }
    }

    int first_fit(std::span<const int> order) {
        for (const int v : order) colour_[v] = kNone;
        int count = 0;
        for (const int v : order) {
            find_taken(v, count);
            const auto free = std::find(taken_.begin(), taken_.end(), 0);
            colour_[v] = static_cast<int>(free - taken_.begin());
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
            colour_[v] = best;
        }
    }

    const VertexGraph& graph_;
    const std::vector<Place>& places_;
    std::vector<int> colour_;
    std::vector<char> taken_;
};

}  // namespace

VertexLayout make_vertex_layout(std::span<const Stencils> kinds, const Strips& strips) {
    const int vertex_count = static_cast<int>(strips.order.size());
    const VertexGraph graph(vertex_count, kinds);
    const std::vector<Place> places = find_places(graph, strips);

    VertexLayout layout;
    layout.strip_count = strips.count();
    std::vector<std::vector<int>> groups(static_cast<std::size_t>(kPhaseCount * strips.count()));
    for (int v = 0; v < vertex_count; ++v) {
        groups[static_cast<std::size_t>(places[v].phase * strips.count() + places[v].strip)]
            .push_back(v);
    }
    VertexColourer colourer(graph, places);
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
    for (int v = 0; v < vertex_count; ++v) ++begin[segment_of(v) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<int> next = begin;
    layout.vertices.resize(static_cast<std::size_t>(vertex_count));
    for (int v = 0; v < vertex_count; ++v) layout.vertices[next[segment_of(v)]++] = v;
    return layout;
}

}  // namespace weft
