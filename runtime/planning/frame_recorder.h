#pragma once

#include <vector>

#include "runtime/executor.h"
#include "runtime/planning/plan_log.h"
#include "runtime/trace/records.h"

namespace weft {

/// Writes down how frames were planned and how they ran.
class FrameRecorder {
public:
    /// devices  of the whole run
    explicit FrameRecorder(std::size_t devices) : devices_(devices), plans_(devices) {}

    /// Makespans, what every device did, and bytes.
    /// numbers  [device of the plan] its number in the run: not all may be left
    void sum_up(const FramePlan& plan, const RunTimes& times, int substeps,
                const std::vector<int>& numbers, FrameRecord& frame) const;
    /// Every task, planned and run, and every copy. To be called before anything is learnt from it.
    void list(const FramePlan& plan, const RunTimes& times, const TimingModel& timing,
              const std::vector<int>& numbers, FrameRecord& frame);

private:
    std::size_t devices_;
    PlanLog plans_;
};

}  // namespace weft
