#pragma once

#include <cstddef>

// Types for what would be plain ints beside each other: see also MemoryId (memory_map.h) and
// ActiveDevice (executor.h).
namespace weft {

/// Strips [begin, end).
struct StripRange {
    int begin = 0;
    int end = 0;

    constexpr bool empty() const { return begin >= end; }
    friend constexpr bool operator==(const StripRange&, const StripRange&) = default;
};

/// A region of a step by its number: tasks of one share most of their data. Region r does part r
/// of the partition; which device that is for is the planner's business.
enum class RegionId : int {};

constexpr std::size_t index(RegionId region) { return static_cast<std::size_t>(region); }

}  // namespace weft
