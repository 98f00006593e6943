#include "simulation/solver/newton/aggregates.h"

#include <algorithm>

#include "runtime/tbb/parallel.h"

namespace weft {

namespace {

constexpr int kMostAggregates = 256;
constexpr int kFewestVertices = 32;  ///< per aggregate, on average
/// What factoring may take, in multiplications: unknowns * band width^2
constexpr double kMostWork = 6e6;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

double work(int strips, int per_strip) {
    const double unknowns = 3.0 * strips * per_strip;
    const double width = 3.0 * per_strip * std::min(strips, 2);
    return unknowns * width * width;
}

/// Whole packs of 8 per strip where there are that many.
int aggregates_per_strip(int vertices, int strips) {
    const auto fits = [&](int per_strip) {
        return strips * per_strip <= kMostAggregates && work(strips, per_strip) <= kMostWork &&
               strips * per_strip * kFewestVertices <= vertices;
    };
    int best = 1;
    for (const int some : {2, 4, 8, 16, 24, 32, 40, 48}) {
        if (fits(some)) best = some;
    }
    return best;
}

/// Grows aggregates breadth-first within one strip.
class StripGrower {
public:
    StripGrower(const VertexGraph& graph, const Model& model, Aggregates& all, int strip)
        : graph_(graph),
          all_(all),
          first_(strip * all.per_strip),
          begin_(model.strips.begin[at(strip)]),
          end_(model.strips.begin[at(strip + 1)]),
          open_(at(end_ - begin_)) {
        for (int v = begin_; v < end_; ++v) {
            open_[at(v - begin_)] = (*model.positions)[at(v)].w > 0.0f ? 1 : 0;
        }
    }

    void grow() {
        auto left = static_cast<int>(std::ranges::count(open_, 1));
        int taken = 0;
        for (int v = begin_; v < end_; ++v) {
            if (!is_open(v)) continue;
            const int share = std::max(1, all_.per_strip - taken);
            const int size = (left + share - 1) / share;
            const std::vector<int> patch = take_patch(v, size);
            const auto count = static_cast<int>(patch.size());
            left -= count;
            // What is left over between larger ones joins one of them.
            const bool is_scrap = 4 * count < size || taken == all_.per_strip;
            const int neighbour = is_scrap ? beside(patch) : -1;
            if (neighbour >= 0)
                put(patch, neighbour);
            else if (taken < all_.per_strip)
                put(patch, first_ + taken++);
        }
    }

private:
    bool is_open(int v) const { return v >= begin_ && v < end_ && open_[at(v - begin_)] != 0; }

    std::vector<int> take_patch(int seed, int size) {
        std::vector<int> patch{seed};
        open_[at(seed - begin_)] = 0;
        for (std::size_t next = 0; next < patch.size(); ++next) {
            for (const int other : graph_.neighbours(patch[next])) {
                if (static_cast<int>(patch.size()) >= size) return patch;
                if (!is_open(other)) continue;
                open_[at(other - begin_)] = 0;
                patch.push_back(other);
            }
        }
        return patch;
    }

    /// The smallest aggregate of the strip that touches it; -1: none does.
    int beside(const std::vector<int>& patch) const {
        int best = -1;
        for (const int v : patch) {
            for (const int other : graph_.neighbours(v)) {
                if (other < begin_ || other >= end_) continue;
                const int aggregate = all_.of[at(other)];
                if (aggregate == all_.count()) continue;
                if (best < 0 || all_.members[at(aggregate)].size() < all_.members[at(best)].size())
                    best = aggregate;
            }
        }
        return best;
    }

    void put(const std::vector<int>& patch, int aggregate) {
        for (const int v : patch) {
            all_.of[at(v)] = aggregate;
            all_.members[at(aggregate)].push_back(v);
        }
    }

    const VertexGraph& graph_;
    Aggregates& all_;
    int first_, begin_, end_;
    std::vector<char> open_;  ///< [vertices of the strip] 1: free, and in no patch yet
};

}  // namespace

Aggregates make_aggregates(const Model& model, const VertexGraph& graph) {
    const int strips = model.strips.count();
    Aggregates all;
    all.per_strip = aggregates_per_strip(model.vertex_count(), strips);
    all.members.resize(at(strips * all.per_strip));
    all.of.assign(at(model.vertex_count()), all.count());
    for_each_apart(strips, [&](int strip) { StripGrower(graph, model, all, strip).grow(); });
    return all;
}

}  // namespace weft
