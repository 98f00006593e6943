#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include "runtime/trace/trace_reader.h"

namespace weft {

/// Position in trace.frames() of a frame's number; of the last frame if none is given. Throws
/// UserError that names `path` where it is not there.
std::size_t find_frame(const TraceReader& trace, const std::string& path,
                       std::optional<std::uint32_t> number);

/// Substeps of a frame that was read whole.
std::uint32_t substeps_of(const FrameRecord& frame);

/// The predicted time of one substep, as the frame's plan says.
double planned_substep(const FrameRecord& frame);

/// A file that appears whole or not at all; a pipe or device of that name is written as it is.
class WholeFile {
public:
    /// Throws UserError if the place cannot be written.
    explicit WholeFile(std::filesystem::path path);
    /// Takes away what is not finished.
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    /// Throws RunError, e.g. when the disk is full.
    void write(const std::string& text);
    void finish();

private:
    void remove_part() const;
    [[noreturn]] void fail_writing() const;

    std::filesystem::path path_, part_;
    std::FILE* file_ = nullptr;
};

}  // namespace weft
