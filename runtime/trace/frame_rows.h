#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "runtime/trace/records.h"
#include "runtime/trace/row_type.h"

namespace weft::trace {

/// In `frames`: the frame's graph was not recorded.
inline constexpr std::uint32_t kNoGraph = 0xffffffff;

/// The number of a record's graph.
struct GraphNumber {};

/// A record's text in so many bytes: cut where it is too long, filled up with zeros.
struct ShortText {
    std::string FrameRecord::*text;
    std::size_t size;
};

/// A column, and where its value stands in a frame's record.
struct FrameColumn {
    const char* name;
    std::variant<std::uint32_t FrameRecord::*, std::uint64_t FrameRecord::*, double FrameRecord::*,
                 ShortText, GraphNumber>
        value;
    const char* unit = "";
};

/// The rows of a table with one row per frame, and how a frame's record becomes one: columns of the
/// record, then doubles whose number depends on the run. In memory, rows have no gaps.
class FrameRows {
public:
    /// `frames`; the doubles are FrameRecord::busy.
    static FrameRows of_frames(std::size_t device_count);
    /// `energies`; the doubles are FrameRecord::energies and the total of all columns.
    static FrameRows of_energies(const std::vector<std::string>& energies);

    RowType type() const;
    std::vector<std::byte> pack(const FrameRecord& record, std::span<const double> doubles) const;
    /// Sets what has a column, and returns the doubles. Of the graph there is the number alone.
    std::vector<double> unpack(const std::byte* row, FrameRecord& record) const;

private:
    FrameRows(std::span<const FrameColumn> columns, std::vector<std::string> doubles,
              const char* unit);

    std::span<const FrameColumn> columns_;
    std::vector<std::string> doubles_;  ///< their names
    const char* unit_;                  ///< theirs
};

}  // namespace weft::trace
