#pragma once

#include <cstdint>
#include <optional>

#include "runtime/planning/planned_executor.h"

namespace weft {

class ErrorSamples;
class LiveModel;

/// Runs a frame's substeps, again from its start where these did not find what they need.
class FrameRunner {
public:
    explicit FrameRunner(LiveModel& live) : live_(live) {}

    /// A frame begins that was not tried yet.
    void begin_frame();
    /// All substeps of the frame. It runs again from its start as long as a table was too small for
    /// it, and once more if bodies went where contact did not look for them.
    /// samples: which may want the last substep; null: there are none
    RunTimes run(const Step& step, const scheduler::Plan& plan, int frame, ErrorSamples* samples);
    /// The same by a plan that may prove a mistake: then there is no value, the model is at the
    /// frame's start, and the next plan is another one.
    std::optional<RunTimes> run(const FramePlan& plan, int frame, ErrorSamples* samples);
    /// How often the frame was run again for contact.
    std::uint32_t redone() const { return redone_; }

private:
    struct Work {
        const Step& step;
        const scheduler::Plan& plan;
        int frame;
        ErrorSamples* samples;
    };
    RunTimes run(const Work& work, PlannedExecutor::Beginning begun);
    std::optional<RunTimes> try_substeps(const Work& work, PlannedExecutor::Beginning begun);
    RunTimes run_substeps(const Work& work, int first);
    bool lacks_room();

    LiveModel& live_;
    std::uint32_t redone_ = 0;
    bool was_redone_ = false;  ///< the frame before it
};

}  // namespace weft
