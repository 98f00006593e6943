#include "simulation/diagnosis.h"

#include <fmt/format.h>

#include "runtime/error.h"
#include "runtime/executor.h"
#include "runtime/tbb/cpu_device.h"
#include "simulation/diagnostics.h"

namespace weft {

namespace {

struct Finding {
    int substep = 0;
    const Task* task = nullptr;
    BadState bad;
};

scheduler::Plan plan_of_one_task() {
    scheduler::Plan plan;
    plan.placements.push_back({0.0, 1.0, 0});
    plan.order_by_start(1);
    return plan;
}

/// The first task that left something bad, or the last task of the substep that did.
std::optional<Finding> find(const Model& model, const Step& step, Executor& executor) {
    for (int substep = 0; substep < model.scene.substeps; ++substep) {
        for (const Task& task : step.tasks()) {
            Step one;
            one.add(task);
            executor.run(one, plan_of_one_task(), 1, substep);
            if (auto bad = find_non_finite(model)) return Finding{substep, &task, std::move(*bad)};
        }
        // Only a substep's end is a state: before, positions may be far off for good reasons.
        if (auto bad = find_bad_state(model))
            return Finding{substep, &step.tasks().back(), std::move(*bad)};
    }
    return std::nullopt;
}

}  // namespace

void diagnose_frame(int frame, const SimulationState& start, Model& model, Solver& solver) {
    start.put(model, solver);
    const auto device = make_cpu_device(1, {});
    const auto bodies = solver.bodies();
    Executor executor({device.get()}, bodies);
    const Step step = solver.make_step(Partition::whole(model.strips.count()));
    const auto finding = find(model, step, executor);
    start.put(model, solver);
    if (!finding) throw RunError(fmt::format("the simulation diverged in frame {}", frame));
    throw RunError(
        fmt::format("the simulation diverged in frame {}, substep {}, seen after task '{}', "
                    "iteration {}: {}: "
                    "{}; smaller time steps (more substeps) or softer materials may help",
                    frame, finding->substep, finding->task->body->name, finding->task->iteration,
                    vertex_name(model, finding->bad.vertex), finding->bad.what));
}

}  // namespace weft
