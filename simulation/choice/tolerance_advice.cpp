#include "simulation/choice/tolerance_advice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <vector>

#include "simulation/choice/step_trials.h"

namespace weft {

namespace {

constexpr int kMostSubsteps = 4;     ///< times as many as now
constexpr int kMostIterations = 64;  ///< likewise, of all substeps together
constexpr int kMostOfNewton = 16;

/// The fewest iterations, doubled from `first` on, that reach the tolerance.
std::optional<int> find(StepTrials& trials, Method method, int first, int most, double tolerance) {
    for (int iterations = first; iterations <= most; iterations *= 2) {
        if (iterations > trials.most_iterations_of(method)) break;
        if (trials.run(method, iterations).error <= tolerance) return iterations;
    }
    return std::nullopt;
}

}  // namespace

std::string advise_tolerance(const Scene& scene, const SubstepEnds& ends) {
    const SolverSettings& solver = scene.solver;
    std::vector<std::string> ways;
    for (int factor = 1; factor <= kMostSubsteps; factor *= 2) {
        StepTrials trials(scene, ends, factor);
        const int most = kMostIterations / factor * solver.iterations;
        if (const auto enough =
                find(trials, solver.method, solver.iterations, most, solver.tolerance)) {
            ways.push_back(
                fmt::format("{} substeps of {} iterations", factor * scene.substeps, *enough));
        }
        if (factor > 1 || scene.solver.method == Method::kNewton) continue;
        if (const auto enough = find(trials, Method::kNewton, 1, kMostOfNewton, solver.tolerance)) {
            ways.push_back(
                fmt::format("{} substeps of {} iterations by newton", scene.substeps, *enough));
        }
    }
    if (ways.empty()) return "nothing that was tried reaches it";
    return fmt::format("{} would reach it", fmt::join(ways, ", or "));
}

}  // namespace weft
