#include "apps/weft/divide_anew.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>

#include "apps/weft/recorded_scene.h"
#include "runtime/error.h"
#include "scheduler/in_order.h"
#include "simulation/planning/plan_log.h"

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
        std::vector<double> speeds(static_cast<std::size_t>(devices()), 0.0);
        Division best;
        double best_time = kImpossible;
        const auto consider = [&](const Division& division) {
            const double time = predict(division);
            if (time >= best_time) return false;
            best = division;
            best_time = time;
            return true;
        };
        for (int d = 0; d < devices(); ++d) {
            const Division single = Division::single(devices(), strip_count(), d);
            consider(single);
            const double time = predict(single);
            if (time < kImpossible)
                speeds[static_cast<std::size_t>(d)] = 1.0 / std::max(time, 1e-12);
        }
        if (best_time == kImpossible) return Division::single(devices(), strip_count(), 0);
        Division mixture = share(speeds);
        double mixture_time = predict(mixture);
        for (bool better = true; better;) {
            better = false;
            for (const Division& neighbour : mixture.neighbours()) {
                if (predict(neighbour) >= mixture_time) continue;
                mixture_time = predict(neighbour);
                mixture = neighbour;
                better = true;
                break;
            }
        }
        consider(mixture);
        return best;
    }

    FrameRecord record(const Division& division) {
        return record_of(solver_->make_step(division.partition()), division);
    }

private:
    int devices() const { return static_cast<int>(costs_.devices.size()); }
    int strip_count() const { return model_.strips.count(); }

    /// In proportion to the speeds; nothing for devices without any.
    Division share(const std::vector<double>& speeds) const {
        std::vector<double> able;
        std::copy_if(speeds.begin(), speeds.end(), std::back_inserter(able),
                     [](double speed) { return speed > 0.0; });
        const Division shares = Division::proportional(strip_count(), able);
        Division division{std::vector<int>(speeds.size(), 0)};
        auto next = shares.strips.begin();
        for (std::size_t d = 0; d < speeds.size(); ++d) {
            if (speeds[d] > 0.0) division.strips[d] = *next++;
        }
        return division;
    }

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
