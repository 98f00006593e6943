#include "apps/weft/plan/divide_anew.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

#include "apps/weft/trace/recorded_scene.h"
#include "runtime/error.h"
#include "runtime/planning/division_search.h"
#include "runtime/planning/plan_log.h"
#include "scheduler/in_order.h"
#include "simulation/solver/solver.h"

namespace weft {

namespace {

constexpr double kImpossible = std::numeric_limits<double>::infinity();

class Divider {
public:
    Divider(const RunDescription& run, const MachineCosts& costs)
        : run_(run),
          costs_(costs),
          model_(recorded_scene(run, std::nullopt), warnings_),
          solver_(make_solver(model_)) {
        if (solver_->kinds() == run.kinds) return;
        throw UserError(
            "the solver has other kinds of tasks here; the trace may be of another "
            "version of weft");
    }

    Division given(const std::vector<int>& strips) const {
        const int sum = std::accumulate(strips.begin(), strips.end(), 0);
        if (static_cast<int>(strips.size()) == devices() && sum == strip_count()) return {strips};
        throw UserError(
            fmt::format("--strips {}: expected a number for each of {} devices, {} in "
                        "all",
                        fmt::join(strips, ","), devices(), strip_count()));
    }

    Division best() {
        std::vector<int> all(static_cast<std::size_t>(devices()));
        std::iota(all.begin(), all.end(), 0);
        return DivisionSearch(devices(), strip_count(), std::move(all),
                              [this](const Division& division) { return predict(division); })
            .best();
    }

    FrameRecord record(const Division& division) {
        return record_of(solver_->make_step(division.partition()), division);
    }

private:
    int devices() const { return static_cast<int>(costs_.devices.size()); }
    int strip_count() const { return model_.strips.count(); }

    /// With every task on the device that has its strips, as runs plan it.
    double predict(const Division& division) {
        const auto [known, is_new] = times_.try_emplace(division, kImpossible);
        if (!is_new) return known->second;
        const FrameRecord frame = record(division);
        const auto can_run = [&](const PlanRecord& task) {
            return costs_.kinds[task.kind][task.home].has_value();
        };
        if (!std::all_of(frame.plan.begin(), frame.plan.end(), can_run)) return kImpossible;
        known->second = in_order_.makespan(rebuild_graph(run_, frame, costs_, true));
        return known->second;
    }

    const RunDescription& run_;
    const MachineCosts& costs_;
    Warnings warnings_;
    Model model_;
    std::unique_ptr<Solver> solver_;
    scheduler::InOrder in_order_;
    std::map<Division, double> times_;
};

}  // namespace

FrameRecord divide_anew(const RunDescription& run, const MachineCosts& costs,
                        const std::vector<int>& strips) {
    Divider divider(run, costs);
    return divider.record(strips.empty() ? divider.best() : divider.given(strips));
}

}  // namespace weft
