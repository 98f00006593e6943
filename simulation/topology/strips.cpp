#include "simulation/topology/strips.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>

#include "scheduler/assert.h"
#include "simulation/topology/vertex_order.h"

namespace weft {
namespace {

/// What a cut just before new vertex p would mean, for every p in [0, vertex_count].
struct CutTable {
    std::vector<int> hull_begin;     ///< elements across the cut touch [hull_begin, hull_end);
    std::vector<int> hull_end;       ///< no vertex below p shares an element with one from here on
    std::vector<std::int64_t> work;  ///< of the vertices, and of the elements that begin, below p
    std::vector<std::int64_t> across;  ///< work of the elements across the cut
};

/// Adds each element by its lowest and highest new vertex. An element is as much work as it has
/// vertices, and each vertex is one more for the vertex-wise steps.
void add_elements(const Stencils& kind, const std::vector<int>& rank, CutTable& table) {
    for (int e = 0; e < kind.count(); ++e) {
        int low = std::numeric_limits<int>::max(), high = 0;
        for (int v : kind[e]) {
            low = std::min(low, rank[v]);
            high = std::max(high, rank[v]);
        }
        table.hull_end[low + 1] = std::max(table.hull_end[low + 1], high + 1);
        table.hull_begin[high] = std::min(table.hull_begin[high], low);
        table.work[low + 1] += kind.arity;
        table.across[low + 1] += kind.arity;
        table.across[high + 1] -= kind.arity;
    }
}

CutTable make_cut_table(int vertex_count, std::span<const Stencils> kinds,
                        const std::vector<int>& rank) {
    const auto size = static_cast<std::size_t>(vertex_count) + 1;
    CutTable table{std::vector<int>(size), std::vector<int>(size),
                   std::vector<std::int64_t>(size, 1), std::vector<std::int64_t>(size, 0)};
    for (int p = 0; p <= vertex_count; ++p) table.hull_begin[p] = table.hull_end[p] = p;
    table.work[0] = 0;
    for (const Stencils& kind : kinds) add_elements(kind, rank, table);
    for (int p = 1; p <= vertex_count; ++p) {
        table.hull_end[p] = std::max(table.hull_end[p], table.hull_end[p - 1]);
        table.work[p] += table.work[p - 1];
        table.across[p] += table.across[p - 1];
    }
    for (int p = vertex_count; p > 0; --p) {
        table.hull_begin[p - 1] = std::min(table.hull_begin[p - 1], table.hull_begin[p]);
    }
    return table;
}

int wanted_strips(int vertex_count, const StripOptions& options) {
    const int most = vertex_count / std::max(1, options.min_vertices_per_strip);
    const int max_vertices = std::max(1, options.max_vertices_per_strip);
    const int least = (vertex_count + max_vertices - 1) / max_vertices;
    return std::max({1, least, std::min(options.target_strips, most)});
}

/// A place where the order may be cut.
struct Cut {
    int position;
    int hull_begin;
    int reach;      ///< the next cut's hull may begin here at the earliest
    double work;    ///< below the cut, in units of one strip's fair share
    double across;  ///< in the same unit
};

class Cutter {
public:
    Cutter(const CutTable& table, const VertexOrder& vertices, const StripOptions& options);

    /// Positions of the cuts, 0 and vertex_count included.
    std::vector<int> best_cuts() const;

private:
    void collect_cuts(const VertexOrder& vertices);
    Cut make_cut(int position) const;
    bool is_strip(const Cut& from, const Cut& to) const;
    double cost(const Cut& from, const Cut& to) const;
    double usual_seam() const;

    const CutTable& table_;
    int extra_levels_;
    int min_vertices_;
    double scale_;  ///< from work to strips' fair shares
    std::vector<Cut> cuts_;
    double usual_seam_;
};

Cutter::Cutter(const CutTable& table, const VertexOrder& vertices, const StripOptions& options)
    : table_(table),
      extra_levels_(options.extra_levels),
      min_vertices_(options.min_vertices_per_strip) {
    const int vertex_count = static_cast<int>(vertices.order.size());
    scale_ = wanted_strips(vertex_count, options) / static_cast<double>(table.work.back());
    collect_cuts(vertices);
    usual_seam_ = usual_seam();
}

Cut Cutter::make_cut(int position) const {
    int reach = table_.hull_end[position];
    for (int i = 0; i < extra_levels_; ++i) reach = table_.hull_end[reach];
    return {position, table_.hull_begin[position], reach,
            scale_ * static_cast<double>(table_.work[position]),
            scale_ * static_cast<double>(table_.across[position])};
}

/// Keeps one level boundary, the one with the smallest seam, per 1/64 of a strip: more choice would
/// cost time on long thin meshes and gain nothing.
void Cutter::collect_cuts(const VertexOrder& vertices) {
    constexpr double kChoicesPerStrip = 64;
    const int end = vertices.level_begin.back();
    cuts_.push_back(make_cut(0));
    double slot_begin = 0;
    for (int position : vertices.level_begin) {
        if (position == 0 || position == end) continue;
        const Cut cut = make_cut(position);
        if (cuts_.size() == 1 || (cut.work - slot_begin) * kChoicesPerStrip >= 1) {
            cuts_.push_back(cut);
            slot_begin = cut.work;
        } else if (cut.across < cuts_.back().across) {
            cuts_.back() = cut;
        }
    }
    cuts_.push_back(make_cut(end));
}

/// The mean over all cuts; limited, or else meshes with large seams would get many tiny strips
/// wherever they are narrow.
double Cutter::usual_seam() const {
    constexpr double kMost = 0.1;
    double sum = 0;
    for (const Cut& cut : cuts_) sum += cut.across;
    return std::min(kMost, sum / static_cast<double>(cuts_.size()));
}

bool Cutter::is_strip(const Cut& from, const Cut& to) const {
    return to.hull_begin >= from.reach && to.position - from.position >= min_vertices_;
}

/// A strip's squared deviation from the fair share, and how much its last seam is larger than
/// usual: cuts between components are good, but a mesh where all seams are alike is not cut less
/// for them.
double Cutter::cost(const Cut& from, const Cut& to) const {
    const double deviation = to.work - from.work - 1;
    return deviation * deviation + to.across - usual_seam_;
}

/// Shortest path over the cuts.
std::vector<int> Cutter::best_cuts() const {
    constexpr double kMaxShare = 2.5;  // larger strips only where the thickness leaves no choice
    const std::size_t last = cuts_.size() - 1;
    std::vector<double> best(cuts_.size(), std::numeric_limits<double>::infinity());
    std::vector<std::size_t> previous(cuts_.size(), 0);
    best[0] = 0;
    best[last] = cost(cuts_[0], cuts_[last]);  // one strip: always possible, if not always good
    std::size_t first = 1;
    for (std::size_t i = 0; i < last; ++i) {
        // What a strip from i needs grows with i, so the search for its nearest end goes on.
        while (first <= last && !is_strip(cuts_[i], cuts_[first])) ++first;
        for (std::size_t j = first; j <= last; ++j) {
            if (j > first && cuts_[j].work - cuts_[i].work > kMaxShare) break;
            const double total = best[i] + cost(cuts_[i], cuts_[j]);
            if (total >= best[j]) continue;
            best[j] = total;
            previous[j] = i;
        }
    }
    std::vector<int> positions;
    for (std::size_t i = last; i > 0; i = previous[i]) positions.push_back(cuts_[i].position);
    positions.push_back(0);
    std::ranges::reverse(positions);
    return positions;
}

/// Whether order and rank undo each other, and every strip has vertices.
[[maybe_unused]] bool is_partition(const Strips& strips) {
    const int count = static_cast<int>(strips.order.size());
    for (int v = 0; v < count; ++v) {
        if (strips.rank[strips.order[v]] != v) return false;
    }
    const auto& begin = strips.begin;
    return begin.front() == 0 && begin.back() == count &&
           std::ranges::is_sorted(begin, std::ranges::less_equal());
}

/// Whether the hull of seam s lies within strips s and s + 1, and behind that of seam s - 1.
[[maybe_unused]] bool seams_are_apart(const Strips& strips) {
    for (int s = 0; s < strips.seam_count(); ++s) {
        const int first = strips.seam_begin[s], last = strips.seam_end[s];
        if (first > last || first < strips.begin[s] || last > strips.begin[s + 2]) return false;
        if (s > 0 && first < strips.seam_end[s - 1]) return false;
    }
    return true;
}

}  // namespace

int Strips::strip_of(int vertex) const {
    const auto next = std::upper_bound(begin.begin(), begin.end(), vertex);
    return static_cast<int>(next - begin.begin()) - 1;
}

Strips make_strips(int vertex_count, std::span<const Stencils> kinds, const StripOptions& options) {
    Strips strips;
    strips.begin.push_back(0);
    if (vertex_count == 0) return strips;

    VertexOrder vertices = order_vertices(vertex_count, kinds);
    strips.rank.resize(static_cast<std::size_t>(vertex_count));
    for (int v = 0; v < vertex_count; ++v) strips.rank[vertices.order[v]] = v;
    const CutTable table = make_cut_table(vertex_count, kinds, strips.rank);
    strips.begin = Cutter(table, vertices, options).best_cuts();
    strips.order = std::move(vertices.order);
    for (int s = 1; s < strips.count(); ++s) {
        strips.seam_begin.push_back(table.hull_begin[strips.begin[s]]);
        strips.seam_end.push_back(table.hull_end[strips.begin[s]]);
    }
    WEFT_ASSERT(is_partition(strips));
    WEFT_ASSERT(seams_are_apart(strips));
    return strips;
}

}  // namespace weft
