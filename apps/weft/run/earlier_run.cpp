#include "apps/weft/run/earlier_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/error.h"

namespace weft {

namespace {

namespace fs = std::filesystem;

/// Where it is: aside, if an earlier resumption was killed while it took it over.
fs::path current(const fs::path& file) {
    const fs::path before = OutputFolder::before(file);
    return fs::exists(before) ? before : file;
}

/// How much of a file counts that has `count` frames from the run's number `first` on, where those
/// before `end` do. None may be missing in between.
std::size_t count_before(std::size_t end, std::size_t first, std::size_t count,
                         const fs::path& file, const char* option) {
    if (first + count >= end) return end - std::min(first, end);
    throw UserError(fmt::format(
        "{}: --resume needs {} of the run, and it ends with {}; {} goes on without it, --force "
        "starts the run anew",
        file.string(), end, first + count, option));
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
                       const Outputs& outputs, const RunDescription& run)
    : frames_(checkpoint.frame), report_(checkpoint.report) {
    if (outputs.trace) open_trace(current(folder.trace()), run);
    if (outputs.geometry) open_geometry(current(folder.geometry()), outputs);
}

void EarlierRun::open_trace(const fs::path& file, const RunDescription& run) {
    if (!fs::exists(file)) return;
    trace_.emplace(file);
    check_devices(file, trace_->run(), run);
    const auto& frames = trace_->frames();
    if (frames.empty()) return;  // killed before there was one
    const std::size_t first = frames.front().frame;
    traced_ =
        count_before(static_cast<std::size_t>(frames_), first, frames.size(), file, "--no-trace");
}

void EarlierRun::open_geometry(const fs::path& file, const Outputs& outputs) {
    if (!fs::exists(file)) return;
    geometry_.emplace(file);
    if (geometry_->steps() == 0) return;
    const auto first =
        static_cast<std::size_t>(std::lround(geometry_->time(0) / outputs.state_interval));
    states_ = count_before(outputs.states, first, geometry_->steps(), file, "--no-geometry");
}

void EarlierRun::hand_over(TraceWriter& trace) const {
    for (std::size_t i = 0; i < traced_; ++i) trace.append(trace_->frame(i));
}

void EarlierRun::hand_over(GeometryWriter& geometry) const {
    for (std::size_t step = 0; step < states_; ++step) {
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
