#include "simulation/solver/halo.h"

#include <algorithm>
#include <numeric>

namespace weft {

Halo::Halo(const Model& model) : lowest_(model.strips.order.size()), highest_(lowest_.size()) {
    std::iota(lowest_.begin(), lowest_.end(), 0);
    std::iota(highest_.begin(), highest_.end(), 0);
    for (const Stencils& kind : model.stencils()) {
        for (int e = 0; e < kind.count(); ++e) {
            const auto [low, high] = std::ranges::minmax(kind[e]);
            for (const int v : kind[e]) {
                int& lowest = lowest_[static_cast<std::size_t>(v)];
                int& highest = highest_[static_cast<std::size_t>(v)];
                lowest = std::min(lowest, low);
                highest = std::max(highest, high);
            }
        }
    }
}

std::pair<int, int> Halo::around(int begin, int end) const {
    if (begin >= end) return {begin, end};
    return {*std::min_element(lowest_.begin() + begin, lowest_.begin() + end),
            *std::max_element(highest_.begin() + begin, highest_.begin() + end) + 1};
}

}  // namespace weft
