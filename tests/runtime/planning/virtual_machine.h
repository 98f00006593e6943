#pragma once

#include <memory>
#include <vector>

#include "runtime/planning/frame_planner.h"

namespace weft::test {

/// Devices that take exactly as long as they are told, and run nothing.
class VirtualMachine {
public:
    struct Speed {
        double fixed = 0.0;     ///< [s] per task
        double per_item = 0.0;  ///< [s]
        /// [kind] how much longer than that; empty: all alike.
        std::vector<double> by_kind = {};
        /// How many times as long everything takes in the first frame after one without a task,
        /// its exchange included.
        double waking = 1.0;

        double operator()(const Task& task) const {
            const double factor =
                by_kind.empty() ? 1.0 : by_kind[static_cast<std::size_t>(task.body->kind)];
            return fixed + factor * per_item * static_cast<double>(task.items);
        }
    };
    /// teams  [device]; empty: all are of one. Those of other teams than the first have two cores
    VirtualMachine(std::vector<Speed> speeds, double latency, const std::vector<int>& teams = {});

    /// Executes a plan as an executor would: every device its tasks in the plan's order, each as
    /// soon as its data are there.
    RunTimes run(const FramePlan& plan, int instances);

    std::vector<Device*> devices() const;

    std::vector<Speed> speeds;
    double latency;  ///< [s] between two devices

private:
    std::vector<std::unique_ptr<Device>> devices_;
    std::vector<bool> asleep_;
    double clock_ = 0.0;
};

}  // namespace weft::test
