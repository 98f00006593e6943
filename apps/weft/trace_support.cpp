#include "apps/weft/trace_support.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

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

WholeFile::WholeFile(std::filesystem::path path) : path_(std::move(path)), part_(path_) {
    const bool replaceable =
        !std::filesystem::exists(path_) || std::filesystem::is_regular_file(path_);
    if (replaceable) part_ += ".part";
    errno = 0;
    file_ = std::fopen(part_.c_str(), "wb");
    if (file_ != nullptr) return;
    throw UserError(fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
}

WholeFile::~WholeFile() {
    if (file_ == nullptr) return;
    std::fclose(file_);
    remove_part();
}

void WholeFile::remove_part() const {
    std::error_code ignored;
    if (part_ != path_) std::filesystem::remove(part_, ignored);
}

void WholeFile::write(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail_writing();
}

void WholeFile::finish() {
    if (std::fflush(file_) != 0) fail_writing();
    const bool closed = std::fclose(file_) == 0;
    file_ = nullptr;
    if (closed && (part_ == path_ || std::rename(part_.c_str(), path_.c_str()) == 0)) return;
    const int reason = errno;
    remove_part();
    errno = reason;
    fail_writing();
}

void WholeFile::fail_writing() const {
    throw RunError(fmt::format("{}: cannot write: {}", path_.string(), std::strerror(errno)));
}

}  // namespace weft
