#pragma once

#include <memory>
#include <vector>

#include "runtime/planning/frame_planner.h"
#include "runtime/trace/records.h"

namespace weft {

/// Writes down how a frame was planned: enough to plan it again, and to run it again.
class PlanLog {
public:
    /// devices  of the whole run
    explicit PlanLog(std::size_t devices) : devices_(devices) {}

    /// Fills the record's plan, its planner, graph, costs and links. To be called before anything
    /// is learnt from how the plan ran.
    /// numbers  [processor of the plan] number of the device: not all devices of a run may be left
    void record(const FramePlan& plan, const TimingModel& timing, const std::vector<int>& numbers,
                FrameRecord& frame);

private:
    std::shared_ptr<const GraphRecord> graph_of(const FramePlan& plan,
                                                const std::vector<int>& numbers);

    std::size_t devices_;
    std::vector<std::shared_ptr<const GraphRecord>> graphs_;  ///< each once: most frames share one
};

/// A step's tasks and its graph: a frame that nobody has planned yet.
FrameRecord record_of(const Step& step, const Division& division);

}  // namespace weft
