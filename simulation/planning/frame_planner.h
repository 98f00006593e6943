#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "scheduler/heft.h"
#include "scheduler/in_order.h"
#include "scheduler/pace.h"
#include "scheduler/plan_choice.h"
#include "scheduler/probing.h"
#include "simulation/planning/division.h"
#include "simulation/planning/plan_kind.h"
#include "simulation/planning/timing_model.h"
#include "simulation/solver/solver.h"

namespace weft {

/// What is to be done in the next frame's substeps, and what it will take.
struct FramePlan {
    const Step* step = nullptr;  ///< owned by the planner
    Division division;
    scheduler::Plan plan;                         ///< of one substep [s]
    const scheduler::TaskGraph* graph = nullptr;  ///< that it was made from; the planner's
    /// How much longer than the costs of its tasks say it is expected to take, as learnt.
    double slowdown = 1.0;
    double plan_time = 0.0;   ///< what planning took [s]
    bool calibrates = false;  ///< made to learn about devices, not to be fast

    /// What a substep is expected to take [s], and what no plan can be expected to undercut.
    double substep_time() const { return plan.makespan * slowdown; }
    double lower_bound() const { return plan.lower_bound() * slowdown; }
};

/// Plans every frame anew: divides the strips among the devices and orders the tasks that follow,
/// with costs learnt from all frames before.
class FramePlanner {
public:
    /// division: instead of searching for one, for tests and studies.
    FramePlanner(Solver& solver, int strip_count, const std::vector<Device*>& devices,
                 PlanKind kind, std::optional<Division> division = std::nullopt);

    /// Plans that make every device and every exchange known; to be run once at the start, each
    /// followed by learn(). State does not matter.
    std::vector<FramePlan> calibration();

    const FramePlan& next();
    /// Learns from how a plan ran.
    void learn(const FramePlan& plan, const RunTimes& times, int instances);

    const TimingModel& timing() const { return timing_; }
    /// Starts from what is known already instead of from calibration().
    TimingModel& timing() { return timing_; }
    /// Divides the mixture by the speeds known now; further steps are small.
    void balance_mixture();

private:
    /// A division's step and its two graphs.
    struct Candidate {
        Step step;
        std::vector<int> devices;     ///< [region]
        scheduler::TaskGraph pinned;  ///< every task on its region's device
        scheduler::TaskGraph free;    ///< every task anywhere, for the bounds
        double makespan = 0.0;        ///< predicted, pinned
        long predicted_in = -1;       ///< the frame in which it was
    };

    int device_count() const { return static_cast<int>(devices_.size()); }
    bool can_mix() const { return device_count() > 1 && strip_count_ > 1; }
    Division single(int device) const {
        return Division::single(device_count(), strip_count_, device);
    }
    Division equal_shares() const {
        return Division::proportional(strip_count_, std::vector<double>(devices_.size(), 1.0));
    }
    /// Among the alternatives that the choice is made from: each single device, then the mixture.
    std::uint32_t alternative_of(const Division& division) const;

    Candidate& candidate(const Division& division);
    static int own_device(const Candidate& c, std::size_t task) {
        return c.devices[static_cast<std::size_t>(c.step.tasks()[task].region)];
    }
    void refresh(const Candidate& candidate, scheduler::TaskGraph& graph, bool pinned);
    bool links_are_current(const scheduler::TaskGraph& graph) const;
    /// Predicted time of a substep.
    double predict(const Division& division);
    /// With what has been learnt of how such plans turn out.
    double expect(const Division& division);
    void improve_mixture();
    Division divide_by_speed();
    Division choose();
    std::optional<Division> probe(const Division& chosen);
    std::vector<Division> trials_of(int device, const Division& chosen) const;
    Division with_one_strip_for(int device, const Division& chosen) const;
    void fill(const Division& division);
    void learn_pace();
    double makespan_of(const Division& division, const std::vector<double>& task_times);

    Solver& solver_;
    int strip_count_;
    std::vector<Device*> devices_;
    PlanKind kind_;
    std::optional<Division> fixed_;
    TimingModel timing_;
    scheduler::PlanChoice choice_;
    scheduler::ProbePolicy probes_;
    Division mixture_;  ///< the best known one of all devices
    std::map<Division, std::unique_ptr<Candidate>> candidates_;
    FramePlan current_;
    scheduler::Pace pace_;
    Division last_division_;        ///< of the last frame
    int last_instances_ = 0;        ///< substeps of it; 0: there was none
    double last_frame_time_ = 0.0;  ///< [s]
    bool last_was_trial_ = false;
    bool is_trial_ = false;  ///< the present plan is made to look at a device again
    double to_beat_ = 0.0;   ///< what the plan chosen instead was expected to take a substep [s]
    long frame_ = 0;
    // Working memory.
    scheduler::InOrder in_order_;
    scheduler::Heft heft_;
    scheduler::LowerBounds bounds_;
    scheduler::Plan trial_;
    std::vector<double> cost_, predicted_;
};

}  // namespace weft
