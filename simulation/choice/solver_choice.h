#pragma once

#include <string>

#include "runtime/planning/planned_executor.h"
#include "simulation/scene/scene.h"

namespace weft {

/// What `method = "auto"` comes to for a scene.
struct SolverChoice {
    Method method = Method::kXpbd;
    int iterations = 0;
    int substeps = 0;  ///< that it was found with
    std::string why;   ///< in words, for messages and traces
};

/// The method and the number of iterations that bring one step of the scene below its tolerance
/// (1e-2 where it has none) in the shortest time, or where none does, as near as possible. They are
/// measured on one core, on a step from where the scene is after a short run. Times differ from
/// call to call, and so may the choice: whoever wants to repeat a run keeps it.
/// plan: how it is going to run; what a method cannot do is not tried
SolverChoice choose_solver(const Scene& scene, PlanKind plan);

/// The scene with a choice, as if it had been written in it: overrides say so, too.
Scene with_choice(Scene scene, const SolverChoice& choice);

/// In one line, and from there; for other processes.
std::string to_text(const SolverChoice& choice);
SolverChoice parse_solver_choice(const std::string& text);

}  // namespace weft
