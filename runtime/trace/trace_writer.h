#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "runtime/trace/records.h"

namespace weft {

/// Writes trace.h5 while the run goes on (docs/trace-format.md).
///
/// `append` hands the record to a background thread; it waits only if the frame before is not yet
/// on disk. So a killed run loses the last frame at most, and a reader may follow along
/// (`h5py.File(path, swmr=True)`). One thread at a time may call the members.
///
/// Errors are RunError with the path and what failed (disk full, not writable); those of the
/// background thread come out of the next `append` or `finish`, and all frames before are on disk.
class TraceWriter {
public:
    /// Creates `path` (an existing file is replaced) with every table that `run` asks for.
    TraceWriter(const std::filesystem::path& path, const RunDescription& run);

    /// Writes out what was appended. The trace stays marked as unfinished unless `finish` was
    /// called.
    ~TraceWriter();

    TraceWriter(const TraceWriter&) = delete;
    TraceWriter& operator=(const TraceWriter&) = delete;

    /// Frames come in rising order. Sizes of `busy` and `energies` must match the RunDescription.
    /// complete: called on the background thread before the record is written, for what takes long
    /// to find out; it may throw nothing.
    void append(FrameRecord record, std::function<void(FrameRecord&)> complete = {});
    /// Waits until the frames so far are written; the next append() then does not.
    void settle();

    /// Waits for the last frame, records the final state hash, marks the trace as finished, closes
    /// it.
    void finish(const std::string& state_hash);

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace weft
