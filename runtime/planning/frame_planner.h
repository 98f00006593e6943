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
    /// The frame was given up, as a substep took longer than the plan has patience; next() gives
    /// another plan for it. To be called instead of learn().
    /// seconds, substep  that were lost, and that the last substep took
    void give_up(const FramePlan& plan, double seconds, double substep);

    const TimingModel& timing() const { return feedback_.timing(); }
    /// Starts from what is known already instead of from calibration().
    TimingModel& timing() { return feedback_.timing(); }
    /// Divides the mixtures by the speeds known now; further steps are small.
    void balance_mixture() { candidates_.balance(); }

private:
    /// What was chosen and has been seen at work.
    struct Settled {
        std::uint32_t alternative = 0;
        double substep = 0.0;  ///< what it took at last [s]
    };

    bool is_wanted(std::uint32_t alternative) const;
    bool needs_trial(std::uint32_t alternative) const;
    void find_expectations();
    void search();
    std::uint32_t choose();
    std::uint32_t or_trial(std::uint32_t chosen);
    double patience() const;
    void settle(const FramePlan& plan, double substep);
    void end_trial(std::uint32_t alternative);

    std::vector<Device*> devices_;
    PlanKind kind_;
    std::optional<Division> fixed_;
    Feedback feedback_;
    Candidates candidates_;
    scheduler::Trials trials_;
    double search_credit_;  ///< seconds that the search for better plans may take now
    FramePlan current_;
    unsigned awake_ = 0;              ///< one bit per device that took part in the last frame
    std::vector<int> where_;          ///< [strip] the device that has its data
    std::uint32_t last_ = 0;          ///< the alternative of the last frame
    int last_instances_ = 0;          ///< its substeps; 0: there was none
    std::optional<Settled> settled_;  ///< none: no frame has run
    int frames_seen_ = 0;             ///< in a row that tell what the chosen alternative takes
    double to_beat_ = 0.0;  ///< what the chosen alternative is expected to take a frame [s]
    std::vector<double> predicted_;  ///< [alternative] of a substep
    std::vector<double> choosable_;  ///< those of them that can be chosen without a trial
    std::vector<double> expected_;   ///< [alternative] of a frame
    std::vector<double> hoped_;      ///< the same, if what speaks against it has passed
};

}  // namespace weft
