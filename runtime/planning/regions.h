#pragma once

#include <algorithm>
#include <vector>

#include "runtime/planning/partition.h"

namespace weft {

/// The strips of one device.
struct Region {
    RegionId id{};
    int begin = 0;
    int end = 0;
    bool cut_before = false;  ///< another region ends where it begins
    bool cut_behind = false;

    StripRange strips() const { return {begin, end}; }
};

/// Calls seams(StripRange) and strips(StripRange) for one sweep of Gauss-Seidel over a region, in
/// an order that hides the exchange between devices. An open seam belongs to the region before it
/// and needs the strip behind it from the sweep before; that strip needs the seam. So the one
/// region does the seam in the middle of its strips, the other one its strip as the last, and
/// either may be half a sweep ahead of the other before it has to wait, from substep to substep,
/// too.
template <class Seams, class Strips>
void for_each_part(const Region& region, Seams seams, Strips strips) {
    const int far_begin = region.cut_before ? region.begin + 1 : region.begin;
    const int middle = region.cut_behind ? far_begin + (region.end - far_begin) / 2 : region.end;
    const auto call = [](auto& visit, StripRange range) {
        if (!range.empty()) visit(range);
    };
    call(seams, {region.begin, region.end - 1});
    call(strips, {far_begin, middle});
    if (region.cut_behind) seams(StripRange{region.end - 1, region.end});
    call(strips, {middle, region.end});
    call(strips, {region.begin, far_begin});
}

/// Calls visit(StripRange) for the strips of a region when all of them take one step at a time
/// (Jacobi): first those that others need for their next one, which then have a whole step to
/// arrive.
template <class Visit>
void for_each_share(const Region& region, Visit visit) {
    const int far_begin = region.cut_before ? region.begin + 1 : region.begin;
    const int far_end = region.cut_behind ? std::max(region.end - 1, far_begin) : region.end;
    const auto call = [&](StripRange range) {
        if (!range.empty()) visit(range);
    };
    call({region.begin, far_begin});
    call({far_end, region.end});
    call({far_begin, far_end});
}

std::vector<Region> regions_of(const Partition& partition);

}  // namespace weft
