#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "runtime/trace/records.h"
#include "simulation/checks/crossing_checks.h"
#include "simulation/checks/error_samples.h"
#include "simulation/checks/inside_checks.h"
#include "simulation/checks/start_contacts.h"
#include "simulation/checks/watch.h"
#include "simulation/output/checkpoint.h"
#include "simulation/run/step_choice.h"
#include "simulation/run/troubles.h"

namespace weft {

class LiveModel;

/// What is done about a frame that has run.
struct Verdict {
    enum class Kind {
        kKeep,
        kAgain,  ///< from its start, with other steps, which the frames that follow keep
        kStop,   ///< nothing can go on from there
    };
    Kind kind = Kind::kKeep;
    Steps steps;  ///< to do it again with
};

/// Looks at frames that have run: judges them, writes down what there is to see, and tells what is
/// to be doubted. Chooses the steps to come by what it sees.
class FrameJudge {
public:
    /// A run begins where the model is. threads: of the host, to look with
    FrameJudge(LiveModel& live, OnTrouble on_trouble, OnCrossing on_crossing, int threads);

    /// A frame that has just run; the host has its state.
    struct Ran {
        int frame = 0;
        std::uint32_t redone = 0;   ///< how often it was run again for contact
        bool may_be_sample = true;  ///< its last substep, of how far steps are solved
    };
    /// record: of the frame; set where it is kept
    Verdict judge(const Ran& ran, FrameRecord& record);
    /// What may help where a state cannot be; the end of a sentence.
    std::string advice() const;
    /// For the frames behind one that is kept; none: they go on as before.
    std::optional<Steps> steps_behind(const FrameRecord& record) const;

    /// Of last substeps; null: nothing is estimated.
    ErrorSamples* samples() { return samples_ ? &*samples_ : nullptr; }
    const Watch& watch() const { return watch_; }
    const Troubles& troubles() const { return troubles_; }

    /// Steps have another length from now on.
    void expect_other_length();
    /// The run goes on where the model is, at a time [s]: anew, or as an earlier one of the scene.
    void restart(double time);
    void resume(double time, const Checkpoint& checkpoint);
    /// What that needs, but for the state and its steps.
    void save(Checkpoint& checkpoint) const;

private:
    Verdict judge(const Ran& ran, const Alarm& alarm);
    Verdict judge(const Ran& ran, const Watch::Look& look, const StepEstimate& estimate);
    Verdict judge_obstacles(const Ran& ran);
    Verdict judge(const Ran& ran, const std::optional<Alarm>& alarm, InsideChecks& checks);
    std::string given_up() const;
    std::optional<StepEstimate> estimate();
    void tell_of_tolerance(int frame, double error);
    ContactResponse* fetch_contact();
    void look_at_contact(const Ran& ran, FrameRecord& record);
    void look_at_crossings(int frame);

    LiveModel& live_;
    OnTrouble on_trouble_;
    StepChoice choice_;
    Watch watch_;
    std::optional<ErrorSamples> samples_;      ///< none: nothing is estimated
    std::optional<CrossingChecks> crossings_;  ///< none: no contact, or energies are not looked at
    std::optional<InsideChecks> inside_;       ///< likewise, or no obstacle to be inside of
    std::optional<InsideChecks> narrow_;       ///< none: no narrow obstacle, or as above
    Troubles troubles_;
    bool tolerance_told_ = false;
};

}  // namespace weft
