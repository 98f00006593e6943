#include "simulation/model/edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/lane_sum.h"
#include "runtime/tbb/parallel.h"
#include "simulation/families/convert.h"

namespace weft {

namespace {

double length_of(const Edge& edge, std::span<const float4> positions) {
    return length(to_vec3(positions[static_cast<std::size_t>(edge.a)]) -
                  to_vec3(positions[static_cast<std::size_t>(edge.b)]));
}

double strain_of(const Edge& edge, std::span<const float4> positions) {
    return std::abs(length_of(edge, positions) / edge.rest - 1.0);
}

struct BlockStrain {
    double squares = 0.0;
    double most = 0.0;
};

WEFT_WIDE BlockStrain strain_of_block(std::span<const Edge> edges,
                                      std::span<const float4> positions) {
    constexpr std::size_t kAtOnce = 256;
    std::array<double, kAtOnce> strains;
    LaneSum squares;
    LaneMaximum most;
    for (; !edges.empty(); edges = edges.subspan(std::min(kAtOnce, edges.size()))) {
        const std::size_t count = std::min(kAtOnce, edges.size());
        for (std::size_t e = 0; e < count; ++e) strains[e] = strain_of(edges[e], positions);
        most.add({strains.data(), count});
        for (std::size_t e = 0; e < count; ++e) strains[e] *= strains[e];
        squares.add({strains.data(), count});
    }
    return {squares.total(), most.total()};
}

}  // namespace

/// Elements that share an edge agree on its length, but for the last bits. Which of them is first
/// depends on the mesh alone.
Edges::Edges(std::span<const Owned<ElementFamily>> families) {
    for (const auto& family : families) family->add_edges(edges_);
    const auto ends = [](const Edge& edge) { return std::minmax(edge.a, edge.b); };
    const auto before = [&](const Edge& a, const Edge& b) { return ends(a) < ends(b); };
    const auto same = [&](const Edge& a, const Edge& b) { return ends(a) == ends(b); };
    std::ranges::stable_sort(edges_, before);
    edges_.erase(std::ranges::unique(edges_, same).begin(), edges_.end());
    // What has no length has no strain.
    std::erase_if(edges_, [](const Edge& edge) { return edge.rest <= 0.0; });
}

double Edges::shortest() const {
    const auto least = std::ranges::min_element(edges_, {}, &Edge::rest);
    return least == edges_.end() ? 0.0 : least->rest;
}

Strain Edges::strain(std::span<const float4> positions) const {
    std::vector<BlockStrain> blocks(static_cast<std::size_t>(block_count(count())));
    for_each_block(count(), [&](int block, int begin, int end) {
        const std::span<const Edge> own(edges_.data() + begin, edges_.data() + end);
        blocks[static_cast<std::size_t>(block)] = strain_of_block(own, positions);
    });
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
    if (edges_.empty() || strain.most <= most) return std::nullopt;
    const auto worst = std::ranges::max_element(
        edges_, {}, [&](const Edge& edge) { return strain_of(edge, positions); });
    return BadState{worst->a, fmt::format("edge of {:g} m is stretched to {:g} m, beyond "
                                          "guard.max_strain = {:g}",
                                          worst->rest, length_of(*worst, positions), most)};
}

}  // namespace weft
