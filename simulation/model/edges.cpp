#include "simulation/model/edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ranges>

#include "runtime/lane_sum.h"
#include "runtime/tbb/parallel.h"
#include "simulation/families/convert.h"

namespace weft {

namespace {

/// Sorted by their ends, each once. Elements that share an edge agree on its length, but for the
/// last bits. Which of them is first depends on the mesh alone.
std::vector<Edge> edges_of(std::span<const Owned<ElementFamily>> families) {
    std::vector<Edge> edges;
    for (const auto& family : families) family->add_edges(edges);
    const auto ends = [](const Edge& edge) { return std::minmax(edge.a, edge.b); };
    const auto before = [&](const Edge& a, const Edge& b) { return ends(a) < ends(b); };
    const auto same = [&](const Edge& a, const Edge& b) { return ends(a) == ends(b); };
    std::ranges::stable_sort(edges, before);
    edges.erase(std::ranges::unique(edges, same).begin(), edges.end());
    // What has no length has no strain.
    std::erase_if(edges, [](const Edge& edge) { return edge.rest <= 0.0; });
    return edges;
}

bool is_single(const Edge& edge) {
    return static_cast<double>(static_cast<float>(edge.rest)) == edge.rest;
}

}  // namespace

RestLengths::RestLengths(std::span<const Edge> edges) {
    if (!std::ranges::all_of(edges, is_single)) {
        exact_.reserve(edges.size());
        for (const Edge& edge : edges) exact_.push_back(edge.rest);
        return;
    }
    single_.reserve(edges.size());
    for (const Edge& edge : edges) single_.push_back(static_cast<float>(edge.rest));
}

Edges::Edges(std::span<const Owned<ElementFamily>> families) : Edges(edges_of(families)) {}

Edges::Edges(std::span<const Edge> edges) : rests_(edges) {
    ends_.reserve(edges.size());
    for (const Edge& edge : edges) ends_.push_back({edge.a, edge.b});
}

double Edges::length_of(std::size_t edge, std::span<const float4> positions) const {
    return length(to_vec3(positions[static_cast<std::size_t>(ends_[edge].a)]) -
                  to_vec3(positions[static_cast<std::size_t>(ends_[edge].b)]));
}

double Edges::strain_of(std::size_t edge, std::span<const float4> positions) const {
    return std::abs(length_of(edge, positions) / rests_[edge] - 1.0);
}

WEFT_WIDE Edges::BlockStrain Edges::strain_of_block(std::size_t begin, std::size_t end,
                                                    std::span<const float4> positions) const {
    constexpr std::size_t kAtOnce = 256;
    std::array<double, kAtOnce> rests, strains;
    const std::span<const Ends> ends = ends_;
    LaneSum squares;
    LaneMaximum most;
    for (std::size_t first = begin; first < end; first += kAtOnce) {
        const std::size_t count = std::min(kAtOnce, end - first);
        for (std::size_t e = 0; e < count; ++e) rests[e] = rests_[first + e];
        for (std::size_t e = 0; e < count; ++e) {
            const Vec3 a = to_vec3(positions[static_cast<std::size_t>(ends[first + e].a)]);
            const Vec3 b = to_vec3(positions[static_cast<std::size_t>(ends[first + e].b)]);
            strains[e] = std::abs(length(a - b) / rests[e] - 1.0);
        }
        most.add({strains.data(), count});
        for (std::size_t e = 0; e < count; ++e) strains[e] *= strains[e];
        squares.add({strains.data(), count});
    }
    return {squares.total(), most.total()};
}

double Edges::shortest() const {
    double least = ends_.empty() ? 0.0 : rests_[0];
    for (std::size_t e = 0; e < ends_.size(); ++e) least = std::min(least, rests_[e]);
    return least;
}

Strain Edges::strain(std::span<const float4> positions) const {
    std::vector<BlockStrain> blocks(static_cast<std::size_t>(block_count(count())));
    for_each_block(count(), [&](int block, int begin, int end) {
        blocks[static_cast<std::size_t>(block)] = strain_of_block(
            static_cast<std::size_t>(begin), static_cast<std::size_t>(end), positions);
    });
    return joined(blocks);
}

Strain Edges::joined(std::span<const BlockStrain> blocks) const {
    Strain strain;
    double squares = 0.0;
    for (const BlockStrain& block : blocks) {
        squares += block.squares;
        strain.most = std::max(strain.most, block.most);
    }
    if (count() > 0) strain.rms = std::sqrt(squares / count());
    return strain;
}

std::optional<BadState> Edges::find_overstretched(std::span<const float4> positions,
                                                  const Strain& strain, double most) const {
    if (ends_.empty() || strain.most <= most) return std::nullopt;
    const auto edges = std::views::iota(std::size_t{0}, ends_.size());
    const std::size_t worst = *std::ranges::max_element(
        edges, {}, [&](std::size_t edge) { return strain_of(edge, positions); });
    return BadState{ends_[worst].a, fmt::format("edge of {:g} m is stretched to {:g} m, beyond "
                                                "guard.max_strain = {:g}",
                                                rests_[worst], length_of(worst, positions), most)};
}

}  // namespace weft
