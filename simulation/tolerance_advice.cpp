#include "simulation/tolerance_advice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "simulation/error_samples.h"
#include "simulation/scene/solver_limits.h"
#include "simulation/simulation.h"

namespace weft {

namespace {

constexpr int kMostSubsteps = 4;     ///< times as many as now
constexpr int kMostIterations = 64;  ///< likewise, of all substeps together
constexpr int kMostOfNewton = 16;

/// Steps of so many to one of now.
class Trials {
public:
    Trials(const Scene& scene, const SubstepEnds& ends, int factor)
        : scene_(one_step(scene, factor)),
          ends_(ends),
          frame_(static_cast<int>(std::lround(ends.time / scene_.dt))),
          error_(scene_, 1) {}

    /// The fewest iterations, doubled from `first` on, that reach the tolerance.
    std::optional<int> find(Method method, int first, int most) {
        scene_.solver.method = method;
        for (int iterations = first; iterations <= most; iterations *= 2) {
            if (iterations > most_iterations(scene_.solver)) break;
            if (error_after(iterations) <= scene_.solver.tolerance) return iterations;
        }
        return std::nullopt;
    }

private:
    static Scene one_step(Scene scene, int factor) {
        scene.dt /= scene.substeps * factor;
        scene.substeps = 1;
        scene.guard.max_speed = scene.guard.max_strain = std::numeric_limits<double>::infinity();
        return scene;
    }

    double error_after(int iterations) {
        scene_.solver.iterations = iterations;
        SimulationOptions options;
        options.devices = "cpu/1";
        options.calibrate = false;
        options.plan = PlanKind::kSingle;
        options.on_trouble = OnTrouble::kIgnore;
        Warnings said_already;
        Simulation simulation(scene_, options, said_already);
        simulation.start_from(frame_, ends_.positions, ends_.velocities);
        simulation.advance({.tasks = false});
        SubstepEnds ends = ends_;
        ends.reached = simulation.positions();
        ends.held = held_by_obstacles(simulation.model(), simulation.time());
        return error_.of(ends).value_or(std::numeric_limits<double>::infinity());
    }

    Scene scene_;
    const SubstepEnds& ends_;
    int frame_;
    StepError error_;
};

}  // namespace

std::string advise_tolerance(const Scene& scene, const SubstepEnds& ends) {
    const SolverSettings& solver = scene.solver;
    std::vector<std::string> ways;
    for (int factor = 1; factor <= kMostSubsteps; factor *= 2) {
        Trials trials(scene, ends, factor);
        const int most = kMostIterations / factor * solver.iterations;
        if (const auto enough = trials.find(solver.method, solver.iterations, most)) {
            ways.push_back(
                fmt::format("{} substeps of {} iterations", factor * scene.substeps, *enough));
        }
        if (factor > 1 || solver.method == Method::kNewton) continue;
        if (const auto enough = trials.find(Method::kNewton, 1, kMostOfNewton)) {
            ways.push_back(
                fmt::format("{} substeps of {} iterations by newton", scene.substeps, *enough));
        }
    }
    if (ways.empty()) return "nothing that was tried reaches it";
    return fmt::format("{} would reach it", fmt::join(ways, ", or "));
}

}  // namespace weft
