#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace weft {

// Groups of numbered things, as of each thing the lowest number in its group.

inline std::vector<int> each_alone(int count) {
    std::vector<int> groups(static_cast<std::size_t>(count));
    std::iota(groups.begin(), groups.end(), 0);
    return groups;
}

/// Makes the groups of a and b one.
inline void join(std::vector<int>& groups, int a, int b) {
    const auto [low, high] =
        std::minmax({groups[static_cast<std::size_t>(a)], groups[static_cast<std::size_t>(b)]});
    std::ranges::replace(groups, high, low);
}

}  // namespace weft
