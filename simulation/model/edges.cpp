#include "simulation/model/edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/tbb/parallel.h"
#include "simulation/families/convert.h"

namespace weft {

namespace {

double length_of(const Edge& edge, std::span<const float4> positions) {
    return length(to_vec3(positions[static_cast<std::size_t>(edge.a)]) -
                  to_vec3(positions[static_cast<std::size_t>(edge.b)]));
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
    struct Block {
        double squares = 0.0;
        Strain worst;
    };
    std::vector<Block> blocks(static_cast<std::size_t>(block_count(count())));
    for_each_block(count(), [&](int block, int begin, int end) {
        Block& own = blocks[static_cast<std::size_t>(block)];
        for (int e = begin; e < end; ++e) {
            const Edge& edge = edges_[static_cast<std::size_t>(e)];
            const double strain = std::abs(length_of(edge, positions) / edge.rest - 1.0);
            own.squares += strain * strain;
            if (strain > own.worst.most) own.worst = {0.0, strain, e};
        }
    });
    Strain strain;
    double squares = 0.0;
    for (const Block& block : blocks) {
        squares += block.squares;
        if (block.worst.most > strain.most) strain = block.worst;
    }
    if (count() > 0) strain.rms = std::sqrt(squares / count());
    return strain;
}

std::optional<BadState> Edges::find_overstretched(std::span<const float4> positions,
                                                  const Strain& strain, double most) const {
    if (strain.edge < 0 || strain.most <= most) return std::nullopt;
    const Edge& edge = edges_[static_cast<std::size_t>(strain.edge)];
    return BadState{edge.a, fmt::format("edge of {:g} m is stretched to {:g} m, beyond "
                                        "guard.max_strain = {:g}",
                                        edge.rest, length_of(edge, positions), most)};
}

}  // namespace weft
