#pragma once

#include <optional>

#include "apps/weft/output_folder.h"
#include "runtime/trace/trace_reader.h"
#include "runtime/trace/trace_writer.h"
#include "simulation/output/checkpoint.h"
#include "simulation/output/geometry_reader.h"
#include "simulation/output/geometry_writer.h"
#include "simulation/output/summary.h"

namespace weft {

/// The files of a run that was stopped or killed, up to its last checkpoint.
class EarlierRun {
public:
    /// Opens what is there in the folder, and touches nothing. run: what goes on. with_trace: its
    /// trace is to be gone on with; geometry_steps: that there are by then. Throws UserError if
    /// there are fewer frames than the checkpoint says, or a trace of other devices.
    EarlierRun(const OutputFolder& folder, const Checkpoint& checkpoint, std::size_t geometry_steps,
               const RunDescription& run, bool with_trace);

    int frames() const { return frames_; }
    bool has_trace() const { return trace_.has_value(); }
    bool has_geometry() const { return geometry_.has_value(); }

    // Its frames, for the run that goes on.
    void hand_over(SummaryBuilder& summary) const { summary.restore(report_); }
    void hand_over(TraceWriter& trace) const;
    void hand_over(GeometryWriter& geometry) const;

private:
    int frames_;
    std::size_t geometry_steps_;
    std::vector<std::uint8_t> report_;
    std::optional<TraceReader> trace_;
    std::optional<GeometryReader> geometry_;
};

/// Moves all times of a frame.
void shift_times(FrameRecord& frame, double seconds);

}  // namespace weft
