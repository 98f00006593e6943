#include "simulation/choice/async_offer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/planning/kind_costs.h"
#include "runtime/tbb/cpu_device.h"
#include "simulation/choice/async_loss.h"
#include "simulation/choice/machine_forecast.h"
#include "simulation/model/model.h"
#include "simulation/simulation.h"
#include "simulation/solver/async_iterates.h"

namespace weft {

namespace {

/// What is gained has to be more than forecasts may be wrong by; as for any other change of plan.
constexpr double kMargin = 0.03;

std::string milliseconds(double seconds) { return fmt::format("{:.3g} ms", 1e3 * seconds); }

/// A scene at rest has nothing to solve yet: then the run is looked at some frames ahead.
std::optional<double> loss_ahead(const Scene& scene, const AsyncSettings& settings, int parts) {
    constexpr int kMostFrames = 8;
    SimulationOptions options;
    options.plan = PlanKind::kSingle;
    options.calibrate = false;
    options.on_trouble = OnTrouble::kReport;
    options.on_crossing = OnCrossing::kWarn;
    std::vector<std::unique_ptr<Device>> devices;
    devices.push_back(make_cpu_device(1, {}));
    Warnings said_already;
    Simulation ahead(scene, std::move(devices), options, said_already);
    while (true) {
        AsyncLoss loss(scene, ahead.frame(), ahead.positions(), ahead.velocities());
        if (const auto factor = loss.factor(settings, parts)) return factor;
        if (ahead.frame() >= kMostFrames) return std::nullopt;
        const int next = std::max(1, 2 * ahead.frame());
        while (ahead.frame() < next) ahead.advance({.tasks = false});
    }
}

const char* name_of_best(const FramePlan& plan) {
    if (plan.is_placed()) return "placed";
    return plan.homes.size() > 1 ? "exact" : "single";
}

}  // namespace

AsyncOffer::AsyncOffer(const Question& question) : others_(question.plan.plan.makespan) {
    KindCosts kinds(question.division.devices(), question.division.strips.size());
    kinds.sum_up(*question.plan.step, question.timing);
    const double bound = kinds.least_time();
    if (bound >= (1.0 - kMargin) * others_) {
        why_ = fmt::format(
            "not async: {} takes {} for a substep, and these devices would take {} even if none of "
            "them ever waited",
            name_of_best(question.plan), milliseconds(others_), milliseconds(bound));
        return;
    }
    compare_times(question);
}

void AsyncOffer::compare_times(const Question& question) {
    const int devices = static_cast<int>(question.division.strips.size());
    const int parts = static_cast<int>(question.division.devices().size());
    AsyncIterates async(question.model, make_solver(question.model), parts, question.settings);
    Forecaster forecaster(question.solver, {&async}, question.model.strips.count(), devices);
    time_ = forecaster.async_time(0, question.division, question.timing);
    // In a row of substeps, as the asynchronous ones are reckoned.
    if (question.plan.homes.size() > 1) {
        others_ = std::min(others_, forecaster.time_of(question.plan.division(), question.timing));
    }
    if (time_ < (1.0 - kMargin) * others_) return compare_errors(question);
    why_ = fmt::format("not async: it would take {} for a substep, {} takes {}",
                       milliseconds(time_), name_of_best(question.plan), milliseconds(others_));
}

void AsyncOffer::compare_errors(const Question& question) {
    const auto parts = static_cast<int>(question.division.devices().size());
    const auto more = loss_ahead(question.model.scene, question.settings, parts);
    const std::string times =
        fmt::format("it would take {} for a substep instead of {}'s {}", milliseconds(time_),
                    name_of_best(question.plan), milliseconds(others_));
    if (!more) {
        why_ = fmt::format(
            "not async: {}, but in its first frames the scene has nothing to solve, so nobody can "
            "say how many iterations more it needs",
            times);
        return;
    }
    is_better_ = time_ * *more < (1.0 - kMargin) * others_;
    why_ = fmt::format("{}async: {}, and {:.3g} times the iterations for the same error: {}",
                       is_better_ ? "" : "not ", times, *more,
                       std::isfinite(*more) ? milliseconds(time_ * *more) : "never");
}

}  // namespace weft
