#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/device.h"
#include "runtime/planning/division_search.h"
#include "runtime/planning/frame_plan.h"
#include "runtime/planning/placement.h"
#include "runtime/planning/step_graph.h"
#include "scheduler/heft.h"
#include "scheduler/in_order.h"

namespace weft {

/// What the planner chooses from, an *alternative* each: every device alone; and for each team of
/// devices (runtime/device.h) the mixture, which is the best division of the strips known, the same
/// with a share for everybody, and the placement of tasks one by one.
class Candidates {
public:
    Candidates(StepMaker& maker, int strip_count, const std::vector<Device*>& devices,
               const TimingModel& timing);

    std::uint32_t count() const { return count(team_count(), device_count_); }
    /// Of so many devices, before there are candidates.
    static std::uint32_t most(std::size_t devices) {
        return count(devices / 2, static_cast<std::uint32_t>(devices));
    }
    std::uint32_t mixture_of(std::size_t team) const { return alternative(team, kMixture); }
    /// The mixture of the same team.
    std::uint32_t mixture_beside(std::uint32_t alternative) const {
        return mixture_of((alternative - device_count_) / kKinds);
    }
    bool is_single(std::uint32_t alternative) const { return alternative < device_count_; }
    bool is_mixture(std::uint32_t alternative) const { return is(alternative, kMixture); }
    bool is_everybody(std::uint32_t alternative) const { return is(alternative, kEverybody); }
    bool is_placed(std::uint32_t alternative) const { return is(alternative, kPlaced); }
    std::uint32_t alternative_of(const Division& division) const;
    /// One bit per device that it needs.
    unsigned devices_of(std::uint32_t alternative) const;
    /// Whether there are two devices, and strips, to share.
    bool can_mix() const { return !teams_.empty(); }

    /// Whether steps can be made for several parts of the strips (StepMaker::can_divide).
    bool can_divide() const { return can_divide_; }
    /// Whether there are strips enough to place tasks one by one.
    bool can_place() const { return can_mix() && teams_.front().placement.possible(); }

    /// To be called when costs have changed: predictions from before are void.
    void forget_predictions() { ++round_; }
    /// One step of the search for a better mixture, for each team.
    void improve_mixtures();
    /// Likewise for placements, where they promise something; or else if they must be found.
    void improve_placements(bool must);
    /// Divides all mixtures by the speeds known now.
    void balance();
    /// What all of a team had a share in has shown to be better than its mixture.
    void adopt_everybody(std::uint32_t alternative);

    /// Seconds of a substep by the costs of its tasks; infinite where it is impossible.
    double predict(std::uint32_t alternative);
    /// The same where forecasts of a device alone disagree (TimingModel::hoped): the shortest.
    double hope(std::uint32_t alternative);
    /// Which device has a strip's data when an alternative begins. [strip]
    std::vector<int> homes_of(std::uint32_t alternative);
    /// What moving a substep's data there takes, from where they are [s].
    double moving_time(const std::vector<int>& from, std::uint32_t alternative);

    /// Without what has been learnt of its kind.
    void fill(std::uint32_t alternative, FramePlan& plan);
    void fill(const Division& division, FramePlan& plan);
    /// A division whose tasks are all run by one device instead, or, without one, as it says: in
    /// the step's own order.
    FramePlan rehearsal(std::size_t team, std::optional<int> device);
    std::size_t team_count() const { return teams_.size(); }
    const std::vector<int>& team(std::size_t t) const { return teams_[t].devices; }

private:
    enum Kind : std::uint32_t { kMixture, kEverybody, kPlaced, kKinds };
    struct Team {
        std::vector<int> devices;
        Division mixture;
        Placement placement;
    };
    struct Prediction {
        std::shared_ptr<StepGraph> graph;
        double time = 0.0;
        long round = -1;
    };

    static std::uint32_t count(std::size_t teams, std::uint32_t devices) {
        return devices + static_cast<std::uint32_t>(teams) * kKinds;
    }
    std::uint32_t alternative(std::size_t team, Kind kind) const {
        return device_count_ + static_cast<std::uint32_t>(team) * kKinds + kind;
    }
    bool is(std::uint32_t alternative, Kind kind) const {
        return alternative >= device_count_ && (alternative - device_count_) % kKinds == kind;
    }
    Team& team_of(std::uint32_t alternative) {
        return teams_[(alternative - device_count_) / kKinds];
    }
    const Team& team_of(std::uint32_t alternative) const {
        return teams_[(alternative - device_count_) / kKinds];
    }
    Division division_of(std::uint32_t alternative);
    DivisionSearch search(const Team& team);
    Prediction& prediction(const Division& division);
    double predict(const Division& division);
    bool copies_data() const;
    const scheduler::TaskGraph& pinned(const Division& division, StepGraph& graph);

    const TimingModel& timing_;
    std::uint32_t device_count_;
    int strip_count_;
    bool can_divide_;
    StepGraphs graphs_;
    std::vector<Team> teams_;
    std::map<Division, Prediction> predictions_;
    long round_ = 0;
    // Working memory.
    scheduler::InOrder in_order_;
    scheduler::Heft heft_;
    scheduler::LowerBounds bounds_;
    scheduler::Plan trial_;
};

}  // namespace weft
