#include "simulation/solver/halo.h"

#include <algorithm>

#include "scheduler/assert.h"

namespace weft {

namespace {

std::vector<int> borders_of(const Strips& strips) {
    std::vector<int> borders = strips.begin;
    borders.insert(borders.end(), strips.seam_begin.begin(), strips.seam_begin.end());
    borders.insert(borders.end(), strips.seam_end.begin(), strips.seam_end.end());
    std::ranges::sort(borders);
    borders.erase(std::ranges::unique(borders).begin(), borders.end());
    return borders;
}

}  // namespace

Halo::Halo(const Model& model) : borders_(borders_of(model.strips)) {
    lowest_.assign(borders_.begin(), borders_.end() - 1);
    for (std::size_t p = 1; p < borders_.size(); ++p) highest_.push_back(borders_[p] - 1);
    for (const Stencils& kind : model.stencils()) {
        for (int e = 0; e < kind.count(); ++e) {
            const auto [low, high] = std::ranges::minmax(kind[e]);
            for (const int v : kind[e]) {
                const std::size_t p = piece(v);
                lowest_[p] = std::min(lowest_[p], low);
                highest_[p] = std::max(highest_[p], high);
            }
        }
    }
}

/// In which it lies.
std::size_t Halo::piece(int vertex) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(borders_, vertex) - borders_.begin()) -
           1;
}

std::pair<int, int> Halo::around(int begin, int end) const {
    if (begin >= end) return {begin, end};
    const std::size_t first = piece(begin), last = piece(end - 1);
    WEFT_ASSERT(borders_[first] == begin && borders_[last + 1] == end);
    const auto at = [](const std::vector<int>& values, std::size_t p) {
        return values.begin() + static_cast<std::ptrdiff_t>(p);
    };
    return {*std::min_element(at(lowest_, first), at(lowest_, last + 1)),
            *std::max_element(at(highest_, first), at(highest_, last + 1)) + 1};
}

}  // namespace weft
