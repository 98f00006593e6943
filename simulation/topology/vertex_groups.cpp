#include "simulation/topology/vertex_groups.h"

#include <algorithm>

#include "runtime/tbb/parallel.h"
#include "scheduler/assert.h"

namespace weft {

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

namespace {

/// Colours the groups of each place, by their leaders, so that neighbours differ. Places may be
/// coloured at the same time.
class VertexColourer {
public:
    VertexColourer(const VertexGraph& graph, const std::vector<Place>& places, const Groups& groups)
        : graph_(graph), places_(places), groups_(groups), colour_(places.size(), kNone) {}

    /// Returns the number of colours.
    int colour_place(std::span<const int> leaders) {
        int count = first_fit(leaders);
        // Iterated greedy (Culberson 1992): first fit, class by class from the last to the first,
        // never needs more colours, and often fewer.
        constexpr int kRounds = 8;
        std::vector<int> order(leaders.begin(), leaders.end());
        for (int round = 0; round < kRounds; ++round) {
            std::stable_sort(order.begin(), order.end(),
                             [&](int a, int b) { return colour_[a] > colour_[b]; });
            count = first_fit(order);
        }
        balance(leaders, count);
        return count;
    }
    int colour(int leader) const { return colour_[leader]; }

private:
    static constexpr int kNone = -1;

    /// Marks the colours of all neighbours of the group in the same place.
    void find_taken(int leader, int count, std::vector<char>& taken) const {
        taken.assign(static_cast<std::size_t>(count) + 1, 0);
        groups_.for_each_member(leader, [&](int v) {
            for (const int other : graph_.neighbours(v)) {
                const int others_leader = groups_.leader(other);
                if (others_leader == leader || !(places_[other] == places_[v])) continue;
                if (colour_[others_leader] != kNone) taken[colour_[others_leader]] = 1;
            }
        });
    }

    int first_fit(std::span<const int> order) {
        for (const int v : order) colour_[v] = kNone;
        int count = 0;
        std::vector<char> taken;
        for (const int v : order) {
            find_taken(v, count, taken);
            const auto free = std::find(taken.begin(), taken.end(), 0);
            colour_[v] = static_cast<int>(free - taken.begin());
            count = std::max(count, colour_[v] + 1);
        }
        return count;
    }

    /// Moves groups to the smallest colour that their neighbours allow: full packs of lanes.
    void balance(std::span<const int> leaders, int count) {
        std::vector<int> size(static_cast<std::size_t>(count), 0);
        std::vector<char> taken;
        for (const int v : leaders) ++size[colour_[v]];
        for (const int v : leaders) {
            find_taken(v, count, taken);
            int best = colour_[v];
            for (int c = 0; c < count; ++c) {
                if (taken[c] == 0 && size[c] + 1 < size[best]) best = c;
            }
            --size[colour_[v]];
            ++size[best];
            colour_[v] = best;
        }
    }

    const VertexGraph& graph_;
    const std::vector<Place>& places_;
    const Groups& groups_;
    std::vector<int> colour_;  ///< [vertices], of leaders
};

}  // namespace

std::vector<int> sort_into_segments(const VertexGraph& graph, const Strips& strips,
                                    const std::vector<Place>& places, const Groups& groups,
                                    VertexLayout& layout) {
    const int vertex_count = graph.vertex_count();
    layout.strip_count = strips.count();
    std::vector<std::vector<int>> leaders(static_cast<std::size_t>(kPhaseCount * strips.count()));
    for (int v = 0; v < vertex_count; ++v) {
        if (!groups.leads(v)) continue;
        leaders[static_cast<std::size_t>(places[v].phase * strips.count() + places[v].strip)]
            .push_back(v);
    }
    VertexColourer colourer(graph, places, groups);
    std::vector<int> counts(leaders.size());
    for_each_apart(static_cast<int>(leaders.size()),
                   [&](int place) { counts[place] = colourer.colour_place(leaders[place]); });
    for (int phase = 0; phase < kPhaseCount; ++phase) {
        int& most = layout.colour_count[static_cast<std::size_t>(phase)];
        for (int strip = 0; strip < strips.count(); ++strip) {
            most = std::max(most, counts[phase * strips.count() + strip]);
        }
    }

    const auto segment_of = [&](int v) {
        return layout.segment(places[v].phase, colourer.colour(v), places[v].strip);
    };
    std::vector<int>& begin = layout.segment_begin;
    begin.assign(static_cast<std::size_t>(layout.segment_count()) + 1, 0);
    for (int v = 0; v < vertex_count; ++v) {
        if (groups.leads(v)) ++begin[segment_of(v) + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    WEFT_ASSERT(begin.back() <= vertex_count);
    std::vector<int> next = begin;
    std::vector<int> sorted(static_cast<std::size_t>(begin.back()));
    for (int v = 0; v < vertex_count; ++v) {
        if (groups.leads(v)) sorted[next[segment_of(v)]++] = v;
    }
    WEFT_ASSERT(std::equal(next.begin(), next.end() - 1, begin.begin() + 1));
    return sorted;
}

}  // namespace weft
