#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "runtime/trace/records.h"

namespace weft {

/// Reads a trace: of a finished run, of one that goes on, or of one that was killed. What counts
/// are complete frames; rows of a frame that was being written are left out. The reader sees the
/// frames that were there when it opened the file.
///
/// Throws UserError if the file is missing, is no trace of Weft, or is of a format it cannot read.
/// Tables and columns that it does not know are ignored; those that are missing read as empty or 0.
class TraceReader {
public:
    explicit TraceReader(const std::filesystem::path& path);
    ~TraceReader();

    TraceReader(const TraceReader&) = delete;
    TraceReader& operator=(const TraceReader&) = delete;

    const RunDescription& run() const;
    const std::string& started() const;     ///< UTC, ISO 8601
    bool finished() const;                  ///< false: going on, failed or killed
    const std::string& state_hash() const;  ///< empty until the run has finished

    /// All complete frames in order, without their plan, graph, executions, costs, links,
    /// transfers and contacts.
    const std::vector<FrameRecord>& frames() const;

    /// Everything about frames()[index].
    FrameRecord frame(std::size_t index) const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace weft
