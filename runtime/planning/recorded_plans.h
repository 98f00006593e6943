#pragma once

#include <cstdint>
#include <functional>
#include <map>

#include "runtime/planning/division.h"
#include "runtime/step.h"
#include "runtime/trace/records.h"
#include "scheduler/plan.h"

namespace weft {

/// The plans of a trace, to be done again: every task on the recorded device, in the recorded
/// order.
///
/// With other devices than the recorded ones, what was device i's goes to device i modulo their
/// number. In strict arithmetic the results are the same.
class RecordedPlans {
public:
    using MakeStep = std::function<Step(const Division&)>;

    /// Whether a task's items are its own and more, frame by frame (row_items.h).
    using ItemsVary = std::function<bool(const Task&)>;

    /// make_step  of the work at hand, which has so many strips
    RecordedPlans(RunDescription recorded, int strip_count, MakeStep make_step,
                  ItemsVary items_vary);

    struct Planned {
        const Step* step = nullptr;  ///< lives as long as this, or until forget_steps()
        scheduler::Plan plan;
    };
    /// Throws UserError if the record does not fit the work, as when another version of Weft cuts
    /// it into other tasks.
    Planned plan_of(const FrameRecord& recorded, std::size_t devices);

    /// To be called when the work makes other steps than before.
    void forget_steps() { steps_.clear(); }

private:
    const Step& step_for(const FrameRecord& recorded);
    void check(const Step& step, const std::vector<PlanRecord>& tasks, std::uint32_t frame) const;

    RunDescription recorded_;
    int strip_count_;
    MakeStep make_step_;
    ItemsVary items_vary_;
    std::map<std::uint32_t, Step> steps_;  ///< by number of the recorded graph
};

/// A frame that cannot be done again, and why.
[[noreturn]] void refuse_replay(std::uint32_t frame, const std::string& what);

}  // namespace weft
