#pragma once

#include <optional>

#include "apps/weft/output_folder.h"
#include "runtime/trace/trace_reader.h"
#include "runtime/trace/trace_writer.h"
#include "simulation/output/geometry_reader.h"
#include "simulation/output/geometry_writer.h"
#include "simulation/output/summary.h"

namespace weft {

/// The files of a run that was stopped or killed, up to its last checkpoint.
class EarlierRun {
public:
    /// Opens what is there in the folder, and touches nothing. frames: done at the checkpoint; run:
    /// what goes on. Throws UserError if there are fewer frames, or other devices.
    EarlierRun(const OutputFolder& folder, int frames, const RunDescription& run);

    int frames() const { return frames_; }
    bool has_trace() const { return trace_.has_value(); }
    bool has_geometry() const { return geometry_.has_value(); }

    /// Writes its frames into the trace and the summary of the run that goes on. Gives the time at
    /// which they ended, for the clock to go on.
    double hand_over(SummaryBuilder& summary, TraceWriter& trace) const;
    void hand_over(GeometryWriter& geometry) const;

private:
    int frames_;
    std::optional<TraceReader> trace_;
    std::optional<GeometryReader> geometry_;
};

/// Moves all times of a frame.
void shift_times(FrameRecord& frame, double seconds);

}  // namespace weft
