#include "simulation/run/step_choice.h"

#include <algorithm>

namespace weft {

StepChoice::StepChoice(const Scene& scene)
    : first_substeps_(scene.substeps), most_iterations_(scene.solver.iterations) {}

std::optional<Steps> StepChoice::halved(const Scene& scene) const {
    constexpr int kMostRefinement = 16;  // times the substeps that the run began with
    const int substeps = 2 * scene.substeps;
    if (substeps > kMostRefinement * first_substeps_) return std::nullopt;
    return Steps{substeps, scene.solver.iterations};
}

bool StepChoice::misses_tolerance(const Scene& scene, double error) {
    const double tolerance = scene.solver.tolerance;
    return !(tolerance == 0.0 || error <= tolerance);
}

std::optional<Steps> StepChoice::with_more_iterations(const Scene& scene) {
    const int iterations = scene.solver.iterations;
    if (iterations >= most_iterations_) return std::nullopt;
    failed_iterations_ = std::max(failed_iterations_, iterations);
    return Steps{scene.substeps, std::min(most_iterations_, 2 * iterations)};
}

std::optional<Steps> StepChoice::with_fewer_iterations(const Scene& scene, double error) const {
    constexpr double kFarBelow = 0.125;
    const SolverSettings& solver = scene.solver;
    const int half = (solver.iterations + 1) / 2;
    if (half == solver.iterations || half <= failed_iterations_) return std::nullopt;
    if (solver.tolerance == 0.0 || !(error <= kFarBelow * solver.tolerance)) return std::nullopt;
    return Steps{scene.substeps, half};
}

}  // namespace weft
