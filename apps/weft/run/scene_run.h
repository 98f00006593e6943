#pragma once

#include <optional>

#include "apps/weft/run/earlier_run.h"
#include "apps/weft/run/interrupt.h"
#include "apps/weft/run/output_folder.h"
#include "apps/weft/run/run_geometry.h"
#include "apps/weft/run/run_options.h"
#include "apps/weft/run/run_origin.h"
#include "simulation/simulation.h"

namespace weft {

/// One `weft run`: a scene, its devices, and everything that it leaves in its output folder.
class SceneRun {
public:
    /// Sets everything up, and claims the output folder. keeps_checkpoint: the one of the end,
    /// which a finished run leaves nobody otherwise. Throws UserError, RunError.
    explicit SceneRun(const RunOptions& options, bool keeps_checkpoint = false);

    /// A run that was to go on and is whole: its summary, as JSON. There is nothing to do then, and
    /// nothing was touched.
    const std::optional<std::string>& done() const { return done_; }

    /// Simulates to the end, or to the frame in which a signal came. Throws RunError; every frame
    /// before is on disk then.
    void advance_all(const InterruptNotice& notice);
    /// Closes all files, and writes the summary. The frames that are not done make it unfinished.
    RunSummary finish();

    int frames_done() const { return simulation_->frame(); }
    int frame_count() const { return scene_.frames; }
    const OutputFolder& folder() const { return folder_; }
    /// Of the scene, of its devices, and of what it goes on from.
    Warnings all_warnings() const;

private:
    std::optional<FinishedRun> find_finished() const;
    void settle_solver();
    RunDescription describe() const;
    void set_up();
    void say_what_runs() const;
    void find_earlier(const RunDescription& description);
    void warn_of_missing_outputs();
    void warn_of_other_scene();
    void claim_folder();
    void take_over();
    void open_geometry();
    void close(FrameRecord& record);
    void append_trace(FrameRecord record);
    void keep_checkpoint();
    Checkpoint checkpoint() const;
    void say_losses(FrameRecord& record);
    FrameRecord advance();
    void say_troubles(Warnings& record);

    RunOptions options_;
    bool keeps_checkpoint_;
    Scene scene_;
    TextPairs origin_;           ///< what the results depend on
    std::string solver_choice_;  ///< why it is that; empty: the scene names its solver
    OutputFolder folder_;
    Warnings warnings_;
    std::optional<Simulation> simulation_;
    std::optional<SummaryBuilder> summary_;
    std::optional<TraceWriter> trace_;
    std::optional<RunGeometry> geometry_;
    std::optional<std::string> done_;
    std::string convergence_;  ///< how far steps are solved, as last estimated
    std::size_t losses_said_ = 0;
    std::size_t troubles_said_ = 0;
    std::optional<EarlierRun> earlier_;  ///< that this run goes on from
    std::optional<Checkpoint> pending_;  ///< written once its frames are on disk
    double last_checkpoint_ = 0.0;       ///< steady-clock seconds
    double last_end_ = 0.0;              ///< of the frame before, by the simulation's clock [s]
    double clock_offset_ = 0.0;          ///< the time that the run before took [s]
};

}  // namespace weft
