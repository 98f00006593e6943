#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "runtime/planning/division.h"
#include "runtime/step.h"
#include "scheduler/plan.h"
#include "scheduler/task_graph.h"

namespace weft {

/// What is to be done in a frame's substeps, and what it will take. It is whole: nothing that the
/// planner does later changes it.
struct FramePlan {
    std::shared_ptr<const Step> step;
    std::vector<int> parts;  ///< [region of the step] how many strips it has
    /// Who has them: [region] device; empty where tasks are placed one by one.
    std::vector<int> homes;
    scheduler::TaskGraph graph;  ///< that the plan was made from
    scheduler::Plan plan;        ///< of one substep [s]
    /// How much longer than the costs of its tasks say it is expected to take, as learnt.
    double slowdown = 1.0;
    double plan_time = 0.0;  ///< what planning took [s]
    /// A substep of the frame that takes longer shows that the plan is a mistake [s]. Infinite: of
    /// plans that have been seen at work.
    double patience = std::numeric_limits<double>::infinity();
    bool calibrates = false;        ///< made to learn about devices, not to be fast
    bool waking = false;            ///< runs on a device that has slept: its times tell nothing
    std::uint32_t alternative = 0;  ///< of the planner's, which it belongs to

    bool is_placed() const { return homes.empty(); }
    /// Who gets how many strips; none where tasks are placed one by one.
    Division division() const;
    /// Which device has a strip's data in the end. [strip]
    std::vector<int> strip_devices() const;
    /// One bit per device that has a task.
    unsigned devices() const;

    /// What a substep is expected to take [s], and what no plan can be expected to undercut.
    double substep_time() const { return plan.makespan * slowdown; }
    double lower_bound() const { return plan.lower_bound() * slowdown; }
};

}  // namespace weft
