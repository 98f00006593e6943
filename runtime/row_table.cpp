#include "runtime/row_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/error.h"
#include "scheduler/assert.h"

namespace weft {

namespace {

/// Entries are addressed by ints.
constexpr long kMostEntries = std::numeric_limits<int>::max() - RowTable::kStride;

/// How much room rows get at the most because others, far from them, are long [entries].
constexpr int kMostForAll = 16;

/// By how much rows get longer at least [entries].
constexpr int kLeastMore = 4;

/// A table that was far too small says little of others.
constexpr float kMostUnseen = 4.0f;

/// Rounded up to whole slices.
int slices_of(int items) { return (items + RowTable::kStride - 1) / RowTable::kStride; }

}  // namespace

RowTable::RowTable(std::string name, const Segments& items, int room, std::size_t plenty)
    : name_(std::move(name)),
      items_(items),
      item_count_(items.item(items.strip_count)),
      plenty_(plenty),
      room_(static_cast<std::size_t>(items.strip_count), std::max(room, 0)),
      rows_(name_ + ".rows", 2 * static_cast<std::size_t>(item_count_)),
      counts_(name_ + ".counts", static_cast<std::size_t>(item_count_)),
      needs_(name_ + ".needs", static_cast<std::size_t>(item_count_)),
      entry_begin_(name_ + ".strips", static_cast<std::size_t>(items.strip_count) + 1),
      entries_{&entry_begin_, 0, 1, items.strip_count},
      age_(name_ + ".age", 1) {
    WEFT_ASSERT(items.colour_count == 1);
    WEFT_ASSERT(items.item(0) == 0);
    place_rows();
}

/// One slice more than the rows take: the start of a row without room is an address, too.
std::size_t RowTable::entry_count() const {
    return static_cast<std::size_t>(entries_.item(entries_.strip_count) + kStride);
}

void RowTable::place_rows() {
    long start = 0;
    for (int strip = 0; strip < items_.strip_count; ++strip) {
        const int room = room_[static_cast<std::size_t>(strip)];
        const int first = items_.item(strip);
        const int end = items_.item(strip + 1);
        const long next = start + static_cast<long>(slices_of(end - first)) * kStride * room;
        if (next > kMostEntries) {
            throw RunError("the table '" + name_ + "' would need more than " +
                           std::to_string(kMostEntries) + " entries");
        }
        entry_begin_[static_cast<std::size_t>(strip)] = static_cast<int>(start);
        for (int item = first; item < end; ++item) {
            const int slice = (item - first) / kStride;
            const auto i = static_cast<std::size_t>(item);
            rows_[i] = static_cast<int>(start) + slice * kStride * room + (item - first) % kStride;
            rows_[i + static_cast<std::size_t>(item_count_)] = room;
        }
        start = next;
    }
    entry_begin_[static_cast<std::size_t>(items_.strip_count)] = static_cast<int>(start);
}

int RowTable::most_needed(int strip) const {
    const auto first = needs_.data() + items_.item(strip);
    const auto end = needs_.data() + items_.item(strip + 1);
    return first == end ? 0 : *std::max_element(first, end);
}

bool RowTable::overflowed() const {
    for (int strip = 0; strip < items_.strip_count; ++strip) {
        if (most_needed(strip) > room_[static_cast<std::size_t>(strip)]) return true;
    }
    return false;
}

/// Had everybody had room; no more than grow() can add to.
int RowTable::most_wanted(int strip, std::span<const float> unseen) const {
    const double times = unseen.empty() ? 1.0 : double{unseen[static_cast<std::size_t>(strip)]};
    const double most = std::ceil(static_cast<double>(most_needed(strip)) * times);
    return static_cast<int>(std::min(most, static_cast<double>(kMostEntries / 2)));
}

/// What grow() leaves is never tight.
bool RowTable::is_tight(int strip, int wanted) const {
    return 4L * wanted > 3L * room_[static_cast<std::size_t>(strip)];
}

bool RowTable::is_tight(std::span<const float> unseen) const {
    for (int strip = 0; strip < items_.strip_count; ++strip) {
        if (is_tight(strip, most_wanted(strip, unseen))) return true;
    }
    return false;
}

std::vector<float> RowTable::shortages() const {
    std::vector<float> times(room_.size());
    for (int strip = 0; strip < items_.strip_count; ++strip) {
        const auto s = static_cast<std::size_t>(strip);
        const auto room = static_cast<float>(std::max(room_[s], 1));
        times[s] = std::clamp(static_cast<float>(most_needed(strip)) / room, 1.0f, kMostUnseen);
    }
    return times;
}

/// most: that a strip has
int RowTable::room_for_all(int most) const {
    std::size_t bytes = 1;
    for (const auto& column : columns_) bytes += column->element_size();
    const std::size_t affordable =
        plenty_ / (bytes * static_cast<std::size_t>(std::max(item_count_, 1)));
    return std::max(std::min(most / 2, kMostForAll),
                    static_cast<int>(std::min(affordable, static_cast<std::size_t>(most))));
}

void RowTable::grow(std::span<const float> unseen) {
    std::vector<int> room = room_;
    for (int strip = 0; strip < items_.strip_count; ++strip) {
        const int most = most_wanted(strip, unseen);
        if (!is_tight(strip, most)) continue;
        const int wanted = most + std::max(most / 2, kLeastMore);
        const int last = std::min(strip + 1, items_.strip_count - 1);
        for (int near = std::max(strip - 1, 0); near <= last; ++near) {
            int& own = room[static_cast<std::size_t>(near)];
            own = std::max(own, wanted);
        }
    }
    const int least = room_for_all(*std::ranges::max_element(room));
    std::ranges::transform(room, room_.begin(), [=](int own) { return std::max(own, least); });
    place_rows();
    for (const auto& column : columns_) column->resize(entry_count());
    ++age_[0];
}

void RowTable::forget() {
    for (const auto& column : columns_) column->clear();
}

std::vector<BufferStorage*> RowTable::resized_buffers() {
    std::vector<BufferStorage*> buffers;
    for (const auto& column : columns_) buffers.push_back(column.get());
    return buffers;
}

}  // namespace weft
