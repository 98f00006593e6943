#pragma once

#include <optional>
#include <vector>

#include "runtime/planning/candidates.h"
#include "runtime/planning/feedback.h"
#include "runtime/planning/plan_kind.h"
#include "scheduler/trials.h"

namespace weft {

/// Plans every frame anew. The parts: Candidates knows what can be done and what that takes,
/// Feedback learns from what was done, Trials says when to look again at what the plans leave out;
/// here is the choice.
class FramePlanner {
public:
    /// division: instead of searching for one, for tests and studies.
    FramePlanner(StepMaker& maker, int strip_count, const std::vector<Device*>& devices,
                 PlanKind kind, std::optional<Division> division = std::nullopt);

    /// Plans that make every device and every exchange known; to be run once at the start, each
    /// followed by learn(). State does not matter.
    std::vector<FramePlan> calibration();

    const FramePlan& next();
    /// Learns from how a plan ran.
    void learn(const FramePlan& plan, const RunTimes& times, int instances);

    const TimingModel& timing() const { return feedback_.timing(); }
    /// Starts from what is known already instead of from calibration().
    TimingModel& timing() { return feedback_.timing(); }
    /// Divides the mixtures by the speeds known now; further steps are small.
    void balance_mixture() { candidates_.balance(); }

private:
    bool is_wanted(std::uint32_t alternative) const;
    bool needs_trial(std::uint32_t alternative) const;
    void find_expectations();
    std::uint32_t choose();
    std::uint32_t or_trial(std::uint32_t chosen);
    void end_trial(std::uint32_t alternative);

    std::vector<Device*> devices_;
    PlanKind kind_;
    std::optional<Division> fixed_;
    Feedback feedback_;
    Candidates candidates_;
    scheduler::Trials trials_;
    FramePlan current_;
    unsigned awake_ = 0;      ///< one bit per device that took part in the last frame
    std::vector<int> where_;  ///< [strip] the device that has its data
    int last_instances_ = 0;  ///< substeps of the last frame; 0: there was none
    int frames_seen_ = 0;     ///< in a row that tell what the chosen alternative takes
    double to_beat_ = 0.0;    ///< what the chosen alternative is expected to take a frame [s]
    std::vector<double> predicted_;  ///< [alternative] of a substep
    std::vector<double> choosable_;  ///< those of them that can be chosen without a trial
    std::vector<double> expected_;   ///< [alternative] of a frame
};

}  // namespace weft
