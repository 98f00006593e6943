#pragma once

#include <span>
#include <vector>

namespace weft {

/// The strips of one device.
struct Region {
    int id = 0;
    int begin = 0;
    int end = 0;
    bool cut_before = false;  ///< another region ends where it begins
    bool cut_behind = false;
};

/// cuts: ascending strips in [1, strip_count)
std::vector<Region> regions_between(std::span<const int> cuts, int strip_count);

}  // namespace weft
