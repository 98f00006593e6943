#pragma once

#include <span>
#include <string>

#include "runtime/buffer.h"

namespace weft {

/// Where the rows of items lie: slices of `stride` items (kernels/descent/rows.h), of as many as
/// the widest pack has. A slice never crosses a segment's border, so every pack of lanes lies in
/// one.
class SlicedRows {
public:
    static constexpr int kStride = 16;

    /// segment_begin: of the items, first and last included; lengths: of the items' rows. Where no
    /// segment has as many items, a smaller stride leaves less room empty: as many as it has, or
    /// more.
    SlicedRows(const std::string& name, std::span<const int> segment_begin,
               std::span<const int> lengths, int stride = kStride);

    /// Between the entries of one row.
    int stride() const { return stride_; }
    int item_count() const { return static_cast<int>(slices_.count() / 2); }
    int entry_count() const { return entry_count_; }
    /// Its own or more: the longest from the item on to the end of its slice's half, so that it
    /// will do for a pack of 8 that begins with it. (A wider pack asks two of its items.)
    int length(int item) const { return slices_[2 * static_cast<std::size_t>(item) + 1]; }
    /// How many entries each row of its slice has: those behind its own are read, too, in a pack
    /// with a longer row. They have to name something that may be read, and contribute nothing.
    int room(int item) const;
    std::size_t entry(int item, int k) const {
        return static_cast<std::size_t>(slices_[2 * static_cast<std::size_t>(item)] + stride_ * k);
    }
    Buffer<int>& slices() { return slices_; }

private:
    /// lengths: of its items
    void add_slice(int first, std::span<const int> lengths);

    int stride_;
    Buffer<int> slices_;
    int entry_count_ = 0;
};

}  // namespace weft
