#pragma once

#include <vector>

#include "runtime/planning/division.h"
#include "runtime/planning/timing_model.h"
#include "scheduler/bounds.h"
#include "scheduler/task_graph.h"

namespace weft {

/// What all tasks of each kind together take on each device, and what follows from that alone: as
/// if nothing had to be exchanged, and nobody had to wait.
class KindCosts {
public:
    /// devices  that may run the tasks, of `device_count`
    KindCosts(std::vector<int> devices, std::size_t device_count);

    void sum_up(const Step& step, const TimingModel& timing);

    /// Seconds of a substep that no plan can undercut: a linear program of a few tasks, one per
    /// kind, that may be split at will.
    double least_time();
    /// Whether a device is much better at one kind than at another, compared with another device.
    bool differ() const;
    /// A division for each kind, so that the devices' loads are balanced: all on the device that is
    /// fastest at it at first, then strips go from the busiest device to others, of the kind of
    /// which that helps most. [kind]
    std::vector<Division> balance(int strip_count) const;

private:
    double cost(std::size_t kind, int device) const {
        return cost_[kind * device_count_ + static_cast<std::size_t>(device)];
    }
    std::size_t kind_count() const { return cost_.size() / device_count_; }
    bool differ(int a, int b) const;

    struct Shares;
    bool hand_over(Shares& shares, int strips) const;

    std::vector<int> devices_;
    std::size_t device_count_;
    std::vector<double> cost_;  ///< [kind][device]
    scheduler::TaskGraph kinds_;
    scheduler::LowerBounds bounds_;
};

}  // namespace weft
