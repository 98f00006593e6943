#pragma once

#include "simulation/scene/scene.h"

namespace weft {

/// How many iterations a substep may have. Newton's are long: their tasks are all in one graph, and
/// what so many of them have not solved, further ones will not.
inline int most_iterations(const SolverSettings& solver) {
    constexpr int kMost = 100000;
    constexpr int kMostGradientSteps = 4000;
    if (solver.method != Method::kNewton) return kMost;
    return solver.cg_steps < kMostGradientSteps ? kMostGradientSteps / solver.cg_steps : 1;
}

}  // namespace weft
