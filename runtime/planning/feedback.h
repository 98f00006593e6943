#pragma once

#include <vector>

#include "runtime/executor.h"
#include "runtime/planning/frame_plan.h"
#include "runtime/planning/timing_model.h"
#include "scheduler/pace.h"
#include "scheduler/plan_choice.h"
#include "scheduler/timetable.h"

namespace weft {

/// All that is learnt from how plans ran: what tasks and exchanges take (TimingModel), how much
/// longer than its tasks say each kind of plan takes (PlanChoice), and the machine's pace.
class Feedback {
public:
    Feedback(std::size_t kinds, std::size_t devices, std::uint32_t alternatives);

    const TimingModel& timing() const { return timing_; }
    TimingModel& timing() { return timing_; }
    const scheduler::PlanChoice& choice() const { return choice_; }
    scheduler::PlanChoice& choice() { return choice_; }
    /// How much longer than its tasks' costs say a plan is expected to take in the next frame.
    double slowdown(std::uint32_t alternative) const {
        return choice_.correction(alternative) * pace_();
    }
    double pace() const { return pace_(); }

    /// Learns from `instances` runs of a plan. A trial says nothing of the pace: too little is
    /// known of what it should take.
    void learn(const FramePlan& plan, const RunTimes& times, int instances, bool is_trial);

private:
    void find_costs(const FramePlan& plan);
    void find_typical(const FramePlan& plan, const std::vector<double>& seconds);

    TimingModel timing_;
    scheduler::PlanChoice choice_;
    scheduler::Pace pace_;
    // Working memory.
    scheduler::Timetable timetable_;
    std::vector<double> cost_;                 ///< [task]
    std::vector<double> typical_;              ///< [task]
    std::vector<std::vector<double>> ratios_;  ///< [kind and device]
};

}  // namespace weft
