#pragma once

#include <algorithm>
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

/// Calls visit(begin, end) for the strips of a region in up to four shares, in an order that hides
/// the exchange between devices. The region before a cut does its strip beside it first; the region
/// behind does its strip half-way: so either may be half an iteration ahead of the other before it
/// has to wait.
template <class Visit>
void for_each_share(const Region& region, Visit visit) {
    const int far_begin = region.cut_before ? region.begin + 1 : region.begin;
    const int far_end = region.cut_behind ? std::max(region.end - 1, far_begin) : region.end;
    const int half = region.cut_before ? far_begin + (far_end - far_begin + 1) / 2 : far_end;
    const auto share = [&](int begin, int end) {
        if (begin < end) visit(begin, end);
    };
    share(far_end, region.end);
    share(far_begin, half);
    share(region.begin, far_begin);
    share(half, far_end);
}

/// cuts: ascending strips in [1, strip_count)
std::vector<Region> regions_between(std::span<const int> cuts, int strip_count);

}  // namespace weft
