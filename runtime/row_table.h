#pragma once

#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "kernels/row_stride.h"
#include "runtime/launch.h"

namespace weft {

/// Rows of entries, one per item, that kernels fill anew in every substep: how long they get is
/// known only then. kernels/neighbours.h has kernels for such a table.
///
/// Rows have room for so many entries, the same for all rows of a strip. A kernel that finds more
/// keeps what there is room for, and notes how many there were; the host looks at that at the end
/// of a frame (overflowed()), makes room (grow()) and runs the frame again from its start. So
/// results never depend on the room that there was. As that costs a whole frame, the host makes
/// room between frames, too, where rows come near their end (is_tight()).
///
/// Rows lie in slices, entry k of an item at start + kStride * k (kernels/row_stride.h). The
/// entries of a strip lie together, so that tasks can say by strips what they read and write,
/// whatever the room is.
class RowTable {
public:
    static constexpr int kStride = WEFT_ROW_STRIDE;

    /// Of a table's entries: up to so much is no matter, be it used or not [B]. (On a CPU, memory
    /// that is not touched is none.)
    static constexpr std::size_t kPlenty = std::size_t{64} << 20;

    /// items: one colour, all strips; they do not change. room: per row, at the beginning
    RowTable(std::string name, const Segments& items, int room, std::size_t plenty = kPlenty);

    int item_count() const { return item_count_; }
    /// Whose rows they are, by strips.
    const Segments& items() const { return items_; }
    /// [2 * items] column-major: where an item's entries start, how many there is room for.
    Buffer<int>& rows() { return rows_; }
    /// [items] for the kernel that fills the rows: the entries that each has now.
    Buffer<int>& counts() { return counts_; }
    /// [items] for the kernel that fills the rows: the most that each wanted in this frame.
    Buffer<int>& needs() { return needs_; }
    /// A column of entries. Grows with the table, and has nothing of use then.
    template <class T>
    Buffer<T>& add_column(const std::string& name) {
        auto column = std::make_unique<Buffer<T>>(name_ + "." + name, entry_count());
        Buffer<T>& added = *column;
        columns_.push_back(std::move(column));
        return added;
    }
    /// Strips of the columns, for accesses.
    const Segments& entries() const { return entries_; }

    /// Whether a row wanted more than there was room for; needs() must be the host's.
    bool overflowed() const;
    /// Whether a row wanted so much that there is little left for the next frame.
    /// unseen  as in grow()
    bool is_tight(std::span<const float> unseen = {}) const;
    /// Makes room for all that was wanted and half as much again, in strips where it was tight, and
    /// as much in the strips beside them: where rows get longer, others soon do. So elsewhere too
    /// there is as much, as far as the table takes no more than `plenty` for it; at least half of
    /// the most that a strip has, up to 16.
    /// unseen  [strips] or empty: how many times as much would have been wanted, had what these rows
    ///         are made of had the room that it lacked; see shortages()
    void grow(std::span<const float> unseen = {});
    /// [strips] how many times as much was wanted as there was room for; from 1 to 4.
    std::vector<float> shortages() const;
    /// All entries are zeros again. What reads rows side by side reads beyond the end of short
    /// ones, and takes nothing of what is there; but nothing of what is not a number is not a
    /// number, and a row without any has what others left in its place. (Counts and age stay: who
    /// keeps entries over substeps has to be told, too.)
    void forget();
    /// How often it has grown.
    int generation() const { return age_[0]; }
    /// [1] the same, for kernels that keep entries over substeps: what they kept is gone then.
    Buffer<int>& age() { return age_; }
    /// What grow() and forget() change, for Executor::rebind(): the columns have moved,
    std::vector<BufferStorage*> resized_buffers();
    /// and these have new values, for Executor::host_wrote().
    std::vector<BufferStorage*> written_buffers() { return {&rows_, &entry_begin_, &age_}; }

private:
    std::size_t entry_count() const;
    int most_needed(int strip) const;
    int most_wanted(int strip, std::span<const float> unseen) const;
    bool is_tight(int strip, int wanted) const;
    void place_rows();
    int room_for_all(int most) const;

    std::string name_;
    Segments items_;
    int item_count_;
    std::size_t plenty_;     ///< [B]
    std::vector<int> room_;  ///< [strips]
    Buffer<int> rows_, counts_, needs_;
    Buffer<int> entry_begin_;  ///< [strips + 1]
    Segments entries_;
    std::vector<std::unique_ptr<BufferStorage>> columns_;
    Buffer<int> age_;
};

}  // namespace weft
