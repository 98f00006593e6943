#pragma once

#include <optional>

#include "apps/weft/run/output_folder.h"
#include "runtime/trace/trace_reader.h"
#include "runtime/trace/trace_writer.h"
#include "simulation/output/checkpoint.h"
#include "simulation/output/geometry_reader.h"
#include "simulation/output/geometry_writer.h"
#include "simulation/output/summary_builder.h"

namespace weft {

/// Which files a run writes.
struct Outputs {
    bool trace = true;
    bool geometry = true;
    double state_interval = 0.0;  ///< from one of the geometry's states to the next [s]
    std::size_t states = 0;       ///< of the geometry, from the run's start to the checkpoint
};

/// The files of a run that was stopped or killed, up to its last checkpoint. They may begin later
/// than the run, where it began without them.
class EarlierRun {
public:
    /// Opens what is there in the folder of what the run that goes on writes, and touches nothing.
    /// run: what goes on. Throws UserError if a file ends before the checkpoint, or if the trace is
    /// of other devices.
    EarlierRun(const OutputFolder& folder, const Checkpoint& checkpoint, const Outputs& outputs,
               const RunDescription& run);

    int frames() const { return frames_; }
    bool has_trace() const { return traced_ > 0; }
    bool has_geometry() const { return states_ > 0; }

    // Its frames, for the run that goes on; none where there is no such file.
    void hand_over(SummaryBuilder& summary) const { summary.restore(report_); }
    void hand_over(TraceWriter& trace) const;
    void hand_over(GeometryWriter& geometry) const;

private:
    void open_trace(const std::filesystem::path& file, const RunDescription& run);
    void open_geometry(const std::filesystem::path& file, const Outputs& outputs);

    int frames_;
    std::vector<std::uint8_t> report_;
    std::optional<TraceReader> trace_;
    std::optional<GeometryReader> geometry_;
    std::size_t traced_ = 0;  ///< frames in the trace, up to the checkpoint
    std::size_t states_ = 0;  ///< in the geometry, likewise
};

/// Moves all times of a frame.
void shift_times(FrameRecord& frame, double seconds);

}  // namespace weft
