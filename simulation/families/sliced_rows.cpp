#include "simulation/families/sliced_rows.h"

#include <algorithm>

#include "scheduler/assert.h"

namespace weft {

namespace {

constexpr int kHalf = 8;  ///< lanes of a narrow pack

}  // namespace

SlicedRows::SlicedRows(const std::string& name, std::span<const int> segment_begin,
                       std::span<const int> lengths, int stride)
    : stride_(stride), slices_(name, 2 * lengths.size()) {
    WEFT_ASSERT(segment_begin.back() == std::ssize(lengths));
    for (std::size_t s = 0; s + 1 < segment_begin.size(); ++s) {
        for (int first = segment_begin[s]; first < segment_begin[s + 1]; first += stride) {
            add_slice(first, lengths.subspan(static_cast<std::size_t>(first),
                                             static_cast<std::size_t>(
                                                 std::min(stride, segment_begin[s + 1] - first))));
        }
    }
}

void SlicedRows::add_slice(int first, std::span<const int> lengths) {
    int longest = 0;
    for (int lane = static_cast<int>(lengths.size()) - 1; lane >= 0; --lane) {
        const int length = lengths[static_cast<std::size_t>(lane)];
        WEFT_ASSERT(length >= 0);
        const bool ends_half = lane % kHalf == kHalf - 1;
        longest = ends_half ? length : std::max(longest, length);
        const auto item = 2 * static_cast<std::size_t>(first + lane);
        slices_[item] = entry_count_ + lane;
        slices_[item + 1] = longest;
    }
    entry_count_ += stride_ * *std::ranges::max_element(lengths);
}

/// The longest row of a slice is the longest of one of its halves, whose first items know it.
int SlicedRows::room(int item) const {
    const auto begin = [&](int i) { return slices_[2 * static_cast<std::size_t>(i)]; };
    const int first = item - begin(item) % stride_;  // slices begin at multiples of the stride
    const int second = first + kHalf;
    const bool has_two =
        stride_ > kHalf && second < item_count() && begin(second) == begin(first) + kHalf;
    return has_two ? std::max(length(first), length(second)) : length(first);
}

}  // namespace weft
