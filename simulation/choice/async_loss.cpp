#include "simulation/choice/async_loss.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/error.h"
#include "runtime/tbb/cpu_device.h"
#include "simulation/checks/error_samples.h"
#include "simulation/simulation.h"

namespace weft {

namespace {

/// One substep as a frame, without a guard: what solvers pass through on their way is to be seen.
/// And without planes, which hold back both ways alike, and are no part of E.
Scene substep_of(Scene scene) {
    scene.dt /= scene.substeps;
    scene.substeps = 1;
    scene.solver.tolerance = 0.0;
    if (scene.contact) scene.contact->planes = false;
    scene.guard.max_speed = scene.guard.max_strain = std::numeric_limits<double>::infinity();
    return scene;
}

/// Where a line through two errors, on a logarithmic scale, has the goal: after n - 1 iterations
/// the error was `before`, after n it is `now`.
double crossing(int n, double before, double now, double goal) {
    if (!(before > now) || !(now > 0.0)) return n;
    return n - std::log(goal / now) / std::log(before / now);
}

}  // namespace

AsyncLoss::AsyncLoss(const Scene& scene, int frame, std::vector<float> positions,
                     std::vector<float> velocities)
    : scene_(substep_of(scene)),
      start_{std::move(positions), std::move(velocities), {}, frame * scene.dt, {}},
      substep_(frame * scene.substeps),
      iterations_(scene.solver.iterations),
      estimate_(scene_, 1) {}

AsyncLoss::~AsyncLoss() = default;

std::optional<double> AsyncLoss::error_after(int iterations, const AsyncSettings* settings,
                                             int devices) {
    Scene scene = scene_;
    scene.solver.iterations = iterations;
    SimulationOptions options;
    options.calibrate = false;
    options.on_trouble = OnTrouble::kIgnore;
    options.on_crossing = OnCrossing::kWarn;
    std::vector<std::unique_ptr<Device>> cpus;
    for (int d = 0; d < devices; ++d) cpus.push_back(make_cpu_device(1, {}));
    if (settings != nullptr) {
        options.plan = PlanKind::kAsync;
        options.async = *settings;
    } else {
        options.plan = PlanKind::kSingle;
    }
    Warnings said_already;
    Simulation simulation(scene, std::move(cpus), options, said_already);
    simulation.start_from(substep_, start_.positions, start_.velocities);
    simulation.advance({.tasks = false});
    SubstepEnds ends = start_;
    ends.reached = simulation.positions();
    ends.contacts = simulation.contacts();
    ends.held = held_by_obstacles(simulation.model(), ends.time + simulation.model().h);
    return estimate_.of(ends);
}

std::optional<double> AsyncLoss::factor(const AsyncSettings& settings, int devices) {
    if (!has_goal_) {
        has_goal_ = true;
        goal_ = error_after(iterations_, nullptr, 1);
        if (goal_ && *goal_ > 0.0) needed_ = search(nullptr, 1);
    }
    if (!needed_) return std::nullopt;
    const auto [known, is_new] = known_.try_emplace({to_text(settings), devices});
    if (is_new) {
        if (const auto iterations = search(&settings, devices)) {
            known->second = *iterations / *needed_;
        }
    }
    return known->second;
}

/// Near the scene's, the first number of iterations with an error as small as the goal, or where a
/// curve through the errors has it before.
std::optional<double> AsyncLoss::search(const AsyncSettings* settings, int devices) {
    const double goal = *goal_;
    const auto error = [&](int n) { return error_after(n, settings, devices); };
    int n = iterations_;
    std::optional<double> now = error(n);
    if (!now) return std::nullopt;
    std::optional<double> before;
    while (*now <= goal && n > 1) {
        before = error(n - 1);
        if (!before) return std::nullopt;
        if (*before > goal) return crossing(n, *before, *now, goal);
        now = before;
        --n;
    }
    if (*now <= goal) return n;
    const int most = static_cast<int>(kMost * iterations_);
    for (++n; n <= most; ++n) {
        before = now;
        now = error(n);
        if (!now) return std::nullopt;
        if (*now <= goal) return crossing(n, *before, *now, goal);
    }
    return std::numeric_limits<double>::infinity();
}

}  // namespace weft
