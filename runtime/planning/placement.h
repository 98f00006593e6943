#pragma once

#include <memory>
#include <span>
#include <vector>

#include "runtime/planning/division.h"
#include "runtime/planning/frame_plan.h"
#include "runtime/planning/kind_costs.h"
#include "runtime/planning/step_graph.h"
#include "scheduler/first_ready.h"
#include "scheduler/heft.h"
#include "scheduler/timetable.h"

namespace weft {

/// Tasks placed one by one: the strips are cut into some parts of about the same size, and each
/// task of each part may go to any device. Worth it where one device is good at one kind of task
/// and another device at another kind, which no division of the strips makes use of.
///
/// Two sorts of attempts compete: HEFT over the free graph, by either rank and for several numbers
/// of parts; and shares by kind, where each kind of task has a division of its own among the
/// devices. HEFT looks at one task at a time, and fills idle time with tasks that the device is bad
/// at; shares by kind start from what is best for each kind, and then give away part by part.
/// What counts is the time of a substep in a row of them.
class Placement {
public:
    /// devices  that may run the tasks, of all those of the graphs
    Placement(StepGraphs& graphs, int strip_count, std::vector<int> devices);

    /// Whether there are strips enough for it.
    bool possible() const { return part_count_ >= 2; }

    /// Whether the devices' speeds differ so much by the kind of task that placing may pay, even if
    /// nothing had to be exchanged.
    /// step, best  tasks, and what they take by the best division known [s]
    bool promises(const Step& step, const TimingModel& timing, double best);

    /// Makes one attempt to find a better plan, if there is one left to make. It takes milliseconds
    /// where there are some hundred tasks; the attempts are made anew when costs have changed.
    /// step  any one of the maker
    void improve(const Step& step, const TimingModel& timing);

    bool known() const { return graph_ != nullptr; }
    /// Seconds of a substep by the costs of now; infinite while no plan is known.
    double predict(const TimingModel& timing);
    /// The same in a row of them, as it was when the plan was found. One must be known.
    double period() const { return period_; }
    void fill(const TimingModel& timing, FramePlan& plan);
    /// Which device does the first of a strip's tasks. [strip] A plan must be known.
    std::vector<int> homes() const;

private:
    struct Attempt {
        int parts;
        scheduler::Heft::Rank rank;
    };
    void limit_parts(const Step& step);
    void begin(const TimingModel& timing);
    std::vector<int> parts_for(const std::vector<Division>& shares) const;
    const scheduler::TaskGraph& priced(StepGraph& graph, const TimingModel& timing) const;
    void try_heft(const Attempt& attempt, const TimingModel& timing);
    bool improve_shares(const TimingModel& timing);
    double try_shares(const std::vector<Division>& shares);
    void keep_if_better(const std::shared_ptr<StepGraph>& graph, double period);
    void find_costs(const scheduler::TaskGraph& graph, const scheduler::Plan& plan);

    StepGraphs& graphs_;
    int strip_count_;
    std::vector<int> devices_;
    std::size_t device_count_;
    KindCosts kinds_;
    unsigned allowed_ = 0;
    int part_count_ = 0;  ///< about so many
    scheduler::Heft upward_, in_sequence_{scheduler::Heft::Rank::kGaussSeidel};
    std::vector<Attempt> attempts_;  ///< still to be made
    double least_time_ = 0.0;        ///< of a substep by the costs that the attempts are made with
    double period_ = 0.0;            ///< of the plan
    std::shared_ptr<StepGraph> graph_;
    scheduler::Plan plan_;
    // The search for shares.
    std::shared_ptr<StepGraph> shared_graph_;
    std::vector<Division> shares_;  ///< [kind] parts
    bool is_new_ = false;           ///< the shares have not been tried yet
    double shares_period_ = 0.0;
    std::size_t next_kind_ = 0, kinds_in_vain_ = 0;
    // Working memory.
    scheduler::Plan trial_;
    scheduler::FirstReady first_ready_;
    scheduler::Timetable timetable_;
    scheduler::LowerBounds bounds_;
    std::vector<double> cost_;
};

}  // namespace weft
