#include "simulation/choice/step_trials.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/error.h"
#include "simulation/checks/error_samples.h"
#include "simulation/scene/solver_limits.h"
#include "simulation/simulation.h"

namespace weft {

namespace {

Scene one_step(Scene scene, int parts) {
    scene.dt /= scene.substeps * parts;
    scene.substeps = 1;
    scene.guard.max_speed = scene.guard.max_strain = std::numeric_limits<double>::infinity();
    return scene;
}

SimulationOptions on_one_core() {
    SimulationOptions options;
    options.devices = "cpu/1";
    options.calibrate = false;
    options.plan = PlanKind::kSingle;
    options.on_trouble = OnTrouble::kIgnore;
    options.on_crossing = OnCrossing::kWarn;
    return options;
}

}  // namespace

StepTrials::StepTrials(const Scene& scene, SubstepEnds start, int parts)
    : scene_(one_step(scene, parts)),
      start_(std::move(start)),
      frame_(static_cast<int>(std::lround(start_.time / scene_.dt))),
      error_(scene_, 1) {}

int StepTrials::most_iterations_of(Method method) const {
    SolverSettings solver = scene_.solver;
    solver.method = method;
    return most_iterations(solver);
}

StepTrials::Result StepTrials::run(Method method, int iterations, int repetitions) {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    scene_.solver.method = method;
    scene_.solver.iterations = iterations;
    Warnings said_already;
    Simulation simulation(scene_, on_one_core(), said_already);
    const int rounds = repetitions > 1 ? repetitions + 1 : 1;
    Result result{kNone, kNone};
    for (int round = 0; round < rounds; ++round) {
        simulation.start_from(frame_, start_.positions, start_.velocities);
        try {
            const double seconds = simulation.advance({.tasks = false}).measured_makespan;
            if (round > 0 || rounds == 1) result.seconds = std::min(result.seconds, seconds);
        } catch (const RunError&) {
            return result;
        }
    }
    SubstepEnds ends = start_;
    ends.reached = simulation.positions();
    ends.held = held_by_obstacles(simulation.model(), simulation.time());
    ends.contacts = simulation.contacts();
    result.error = error_.of(ends).value_or(kNone);
    return result;
}

}  // namespace weft
