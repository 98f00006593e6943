#pragma once

#include <memory>
#include <vector>

#include "simulation/planning/frame_planner.h"

namespace weft::test {

/// Devices that take exactly as long as they are told, and run nothing.
class VirtualMachine {
public:
    struct Speed {
        double fixed = 0.0;     ///< [s] per task
        double per_item = 0.0;  ///< [s]
    };
    VirtualMachine(std::vector<Speed> speeds, double latency);

    /// Executes a plan as an executor would: every device its tasks in the plan's order, each as
    /// soon as its data are there.
    RunTimes run(const FramePlan& plan, int instances);

    std::vector<Device*> devices() const;

    std::vector<Speed> speeds;
    double latency;  ///< [s] between two devices

private:
    std::vector<std::unique_ptr<Device>> devices_;
    double clock_ = 0.0;
};

}  // namespace weft::test
