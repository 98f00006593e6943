#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "runtime/trace/trace_reader.h"

namespace weft {

/// Position in trace.frames() of a frame's number; of the last frame if none is given. Throws
/// UserError that names `path` where it is not there.
std::size_t find_frame(const TraceReader& trace, const std::string& path,
                       std::optional<std::uint32_t> number);

/// Numbers of a range, both included.
struct NumberRange {
    std::uint32_t first = 0;
    std::uint32_t last = std::numeric_limits<std::uint32_t>::max();
};

/// "A:B", either left out, or "A". option, things: for the message, as in "--frames" and "frame".
/// Throws UserError.
NumberRange parse_range(const std::string& text, const std::string& option,
                        const std::string& thing);

/// Substeps of a frame that was read whole.
std::uint32_t substeps_of(const FrameRecord& frame);

/// The predicted time of one substep, as the frame's plan says.
double planned_substep(const FrameRecord& frame);

}  // namespace weft
