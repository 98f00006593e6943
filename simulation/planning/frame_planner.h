#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/executor.h"
#include "scheduler/cost_model.h"
#include "scheduler/heft.h"
#include "simulation/planning/division.h"
#include "simulation/solver/solver.h"

namespace weft {

enum class PlanKind {
    kAuto,    ///< the mixture of all devices or a single one, whichever is predicted to be faster
    kExact,   ///< always the mixture
    kSingle,  ///< the best single device
};

/// What is to be done in the next frame's substeps, and what it will take.
struct FramePlan {
    const Step* step = nullptr;  ///< owned by the planner
    Division division;
    scheduler::Plan plan;  ///< of one substep [s]
    double substep_time =
        0.0;  ///< planned [s]: the plan's makespan, corrected as earlier plans were off
    double plan_time = 0.0;  ///< what planning took [s]
};

/// Plans every frame anew: divides the strips among the devices and places the tasks that follow
/// by HEFT, with costs learnt from all frames before.
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

    const scheduler::CostModel& costs() const { return costs_; }
    /// Time from a task's end on one device until one that waits for it starts on another [s].
    double latency(int from, int to) const { return latency_[index(from, to)]; }

private:
    /// A division's step and its two graphs.
    struct Candidate {
        Step step;
        std::vector<int> devices;     ///< [region]
        scheduler::TaskGraph pinned;  ///< every task on its region's device
        scheduler::TaskGraph free;    ///< every task anywhere
        double makespan = 0.0;        ///< predicted, pinned
        long predicted_in = -1;       ///< the frame in which it was
    };

    std::size_t index(int from, int to) const {
        return static_cast<std::size_t>(from) * devices_.size() + static_cast<std::size_t>(to);
    }
    int device_count() const { return static_cast<int>(devices_.size()); }

    Candidate& candidate(const Division& division);
    void refresh(const Candidate& candidate, scheduler::TaskGraph& graph, bool pinned);
    bool links_are_current(const scheduler::TaskGraph& graph) const;
    double task_cost(const Task& task, int device) const;
    /// Predicted time of a substep, corrected.
    double predict(const Division& division);
    double correction(unsigned mask) const;
    Division best_single();
    void improve_mixture();
    Division choose();
    void fill(const Division& division);
    void place_anywhere(Candidate& candidate);

    void learn_tasks(const FramePlan& plan, const RunTimes& times, int instances);
    void learn_correction(const FramePlan& plan, const RunTimes& times, int instances);

    Solver& solver_;
    int strip_count_;
    std::vector<Device*> devices_;
    PlanKind kind_;
    std::optional<Division> fixed_;
    scheduler::CostModel costs_;
    std::vector<double> latency_;   ///< [from][to]
    Division mixture_;              ///< the best known one of all devices
    std::optional<Division> last_;  ///< what the last frame used
    std::map<Division, std::unique_ptr<Candidate>> candidates_;
    std::map<unsigned, std::vector<double>>
        ratios_;  ///< [mask] measured / planned, last few frames
    FramePlan current_;
    long frame_ = 0;
    // Working memory.
    scheduler::Heft heft_;
    scheduler::LowerBounds bounds_;
    scheduler::Plan trial_;
    std::vector<double> cost_;
};

}  // namespace weft
