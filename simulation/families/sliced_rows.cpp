#include "simulation/families/sliced_rows.h"

#include <algorithm>

#include "scheduler/assert.h"

namespace weft {

SlicedRows::SlicedRows(const std::string& name, std::span<const int> segment_begin,
                       std::span<const int> lengths, int stride)
    : stride_(stride), slices_(name, 2 * lengths.size()) {
    WEFT_ASSERT(segment_begin.back() == std::ssize(lengths));
    for (std::size_t s = 0; s + 1 < segment_begin.size(); ++s) {
        for (int first = segment_begin[s]; first < segment_begin[s + 1]; first += stride) {
            const int end = std::min(first + stride, segment_begin[s + 1]);
            int longest = 0;
            for (int i = end - 1; i >= first; --i) {
                const auto at = static_cast<std::size_t>(i);
                WEFT_ASSERT(lengths[at] >= 0);
                longest = std::max(longest, lengths[at]);
                slices_[2 * at] = entry_count_ + i - first;
                slices_[2 * at + 1] = longest;
            }
            entry_count_ += stride * longest;
        }
    }
}

}  // namespace weft
