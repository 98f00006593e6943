#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "apps/weft/studies/error_study.h"
#include "simulation/model/model.h"
#include "simulation/reference/incremental_potential.h"

namespace weft {

/// A state as the simulation gives it: xyz in scene order, counted from the model's origin.
struct State {
    std::vector<float> positions, velocities;
};

/// The state at the start of `frame`, from the whole scene with all that it has.
State state_at(const ErrorOptions& options, const Scene& scene, int frame);

/// The scene of the step alone: one substep, obstacles and planes only if they are asked for, and
/// no guard, since what solvers pass through on their way is to be seen. Throws UserError.
Scene scene_of_step(const ErrorOptions& options, const std::string& solver, int iterations);

/// What touches in the step, as every solver finds it where the step begins: corners in scene
/// order. Empty: nothing, or no [contact].
std::vector<FrozenContact> contacts_of_step(const ErrorOptions& options, const State& start,
                                            int substep);

/// The step that all solvers are measured on.
struct ErrorProblem {
    ErrorProblem(const ErrorOptions& options, State state, int substep);

    /// What errors are counted in [J]: E, or, where an end is given, half the squared distance from
    /// it, weighted by m / h^2.
    double energy(std::span<const Vec3> x) const;

    /// Positions in scene order as the potential wants them. Held vertices are where they belong.
    std::vector<Vec3> from_scene_order(const std::vector<float>& positions) const;

    Warnings warnings;
    Model model;
    int first_substep;  ///< since the run's beginning
    State start;
    std::vector<FrozenContact> contacts;  ///< that the step begins with; corners in scene order
    std::unique_ptr<IncrementalPotential> potential;
    std::vector<Vec3> end;  ///< of the step with obstacles, which are no part of E; empty: E counts
};

}  // namespace weft
