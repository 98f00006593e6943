#include "apps/weft/earlier_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/error.h"

namespace weft {

namespace {

namespace fs = std::filesystem;

/// Where it is: aside, if an earlier resumption was killed while it took it over.
fs::path current(const fs::path& file) {
    const fs::path before = OutputFolder::before(file);
    return fs::exists(before) ? before : file;
}

void check_length(const fs::path& file, const char* what, std::size_t there, std::size_t needed) {
    if (there >= needed) return;
    throw UserError(
        fmt::format("{}: --resume needs {} {}, and there are {}; --force starts the run anew",
                    file.string(), needed, what, there));
}

void check_devices(const fs::path& file, const RunDescription& then, const RunDescription& now) {
    const auto same = [](const DeviceDescription& a, const DeviceDescription& b) {
        return a.name == b.name && a.kind == b.kind && a.units == b.units;
    };
    if (std::ranges::equal(then.devices, now.devices, same)) return;
    throw UserError(file.string() +
                    ": --resume needs the devices of the run that was stopped (its command: " +
                    then.command + ")");
}

}  // namespace

EarlierRun::EarlierRun(const OutputFolder& folder, const Checkpoint& checkpoint,
                       std::size_t geometry_steps, const RunDescription& run, bool with_trace)
    : frames_(checkpoint.frame), geometry_steps_(geometry_steps), report_(checkpoint.report) {
    if (const fs::path file = current(folder.trace()); with_trace && fs::exists(file)) {
        trace_.emplace(file);
        check_length(file, "frames", trace_->frames().size(), static_cast<std::size_t>(frames_));
        check_devices(file, trace_->run(), run);
    }
    if (const fs::path file = current(folder.geometry()); fs::exists(file)) {
        geometry_.emplace(file);
        check_length(file, "steps", geometry_->steps(), geometry_steps_);
    }
}

void EarlierRun::hand_over(TraceWriter& trace) const {
    for (std::size_t i = 0; i < static_cast<std::size_t>(frames_); ++i) {
        trace.append(trace_->frame(i));
    }
}

void EarlierRun::hand_over(GeometryWriter& geometry) const {
    for (std::size_t step = 0; step < geometry_steps_; ++step) {
        geometry.append(geometry_->time(step), geometry_->positions(step));
    }
}

void shift_times(FrameRecord& frame, double seconds) {
    const auto shift = [seconds](auto& span) {
        span.start += seconds;
        span.end += seconds;
    };
    shift(frame);
    std::ranges::for_each(frame.executions, shift);
    std::ranges::for_each(frame.transfers, shift);
}

}  // namespace weft
