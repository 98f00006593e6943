#include "apps/weft/trace/recorded_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "runtime/error.h"

namespace weft {

std::size_t find_frame(const TraceReader& trace, const std::string& path,
                       std::optional<std::uint32_t> number) {
    const auto& frames = trace.frames();
    if (frames.empty()) throw UserError(path + ": the trace has no complete frame");
    if (!number) return frames.size() - 1;
    const auto found = std::find_if(frames.begin(), frames.end(), [&](const FrameRecord& frame) {
        return frame.frame == *number;
    });
    if (found != frames.end()) return static_cast<std::size_t>(found - frames.begin());
    throw UserError(fmt::format("{}: no frame {}; it has {} to {}", path, *number,
                                frames.front().frame, frames.back().frame));
}

NumberRange parse_range(const std::string& text, const std::string& option,
                        const std::string& thing) {
    const auto wrong = [&]() {
        return UserError(fmt::format("{} {}: expected A:B, the first and the last {}, as in 10:19",
                                     option, text, thing));
    };
    const auto number = [&](const std::string& part, std::uint32_t fallback) {
        if (part.empty()) return fallback;
        std::uint32_t value = 0;
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (error != std::errc() || end != part.data() + part.size()) throw wrong();
        return value;
    };
    NumberRange range;
    const std::size_t colon = text.find(':');
    if (text.empty() || text == ":") throw wrong();
    range.first = number(text.substr(0, colon), range.first);
    range.last =
        colon == std::string::npos ? range.first : number(text.substr(colon + 1), range.last);
    if (range.first > range.last) throw wrong();
    return range;
}

std::uint32_t substeps_of(const FrameRecord& frame) {
    std::uint32_t count = 0;
    for (const ExecutionRecord& e : frame.executions) count = std::max(count, e.substep + 1);
    return count;
}

double planned_substep(const FrameRecord& frame) {
    double end = 0.0;
    for (const PlanRecord& task : frame.plan) end = std::max(end, task.end);
    return end;
}

}  // namespace weft
