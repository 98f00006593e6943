#include "simulation/checks/diagnosis.h"

#include <fmt/format.h>

#include "runtime/error.h"
#include "runtime/executor.h"
#include "runtime/tbb/cpu_device.h"
#include "simulation/contact/response.h"
#include "simulation/state/diagnostics.h"

namespace weft {

namespace {

struct Finding {
    int substep = 0;
    const Task* task = nullptr;
    Alarm alarm;
};

scheduler::Plan plan_of_one_task() {
    scheduler::Plan plan;
    plan.placements.push_back({0.0, 1.0, 0});
    plan.order_by_start(1);
    return plan;
}

class Search {
public:
    Search(int frame, const SimulationState& start, const Watch& watch, const Step& step,
           Model& model, Solver& solver)
        : start_(start),
          watch_(watch),
          model_(model),
          begin_(frame * model.scene.dt),
          device_(make_cpu_device(1, {})),
          contact_(solver.contact()),
          bodies_(solver.bodies()),
          executor_({device_.get()}, bodies_),
          step_(step) {}

    /// The first task that left something bad, or the last task of the substep that did.
    std::optional<Finding> find() {
        for (int substep = 0; substep < model_.scene.substeps; ++substep) {
            if (auto finding = find_in(substep)) return finding;
        }
        return std::nullopt;
    }

private:
    std::optional<Finding> find_in(int substep) {
        for (const Task& task : step_.tasks()) {
            Step one;
            one.add(task);
            one.seal();
            executor_.run(one, plan_of_one_task(), 1, substep);
            if (auto bad = find_non_finite(model_)) {
                return Finding{substep, &task, {Alarm::Kind::kNoState, bad->what, bad->vertex}};
            }
        }
        // Only a substep's end is a state: before, positions may be far off for good reasons.
        const double end = begin_ + (substep + 1) * model_.h;
        const auto stored = contact_ != nullptr ? contact_->energy().stored() : StoredInContacts{};
        auto look = watch_.look(model_, start_, begin_, end, stored);
        if (!look.alarm || look.alarm->kind == Alarm::Kind::kDoubt) return std::nullopt;
        return Finding{substep, &step_.tasks().back(), std::move(*look.alarm)};
    }

    const SimulationState& start_;
    const Watch& watch_;
    Model& model_;
    double begin_;  ///< of the frame [s]
    std::unique_ptr<Device> device_;
    ContactResponse* contact_;  ///< null: none
    std::vector<const TaskBody*> bodies_;
    Executor executor_;
    const Step& step_;
};

std::string text_of(int frame, const Finding& finding, const Model& model) {
    const std::string where = fmt::format("frame {}, substep {}", frame, finding.substep);
    if (!finding.alarm.vertex) return fmt::format("{}: {}", where, finding.alarm.what);
    return fmt::format("{}, seen after task '{}', iteration {}: {}: {}", where,
                       finding.task->body->name, finding.task->iteration,
                       vertex_name(model, *finding.alarm.vertex), finding.alarm.what);
}

}  // namespace

void diagnose_frame(int frame, const SimulationState& start, const Watch& watch, const Step& step,
                    Model& model, Solver& solver, const std::string& advice) {
    start.put(model, solver);
    Search search(frame, start, watch, step, model, solver);
    const auto finding = search.find();
    start.put(model, solver);
    const std::string where =
        finding ? text_of(frame, *finding, model) : fmt::format("frame {}", frame);
    throw RunError(fmt::format("the simulation diverged in {}; {}", where, advice));
}

}  // namespace weft
