#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "runtime/trace/records.h"
#include "simulation/output/checkpoint.h"
#include "simulation/solver/solver.h"

namespace weft {

/// A copy of all that a simulation carries from frame to frame.
struct SimulationState {
    std::vector<float4> positions, velocities;   ///< of the model, in the new order
    std::vector<std::vector<std::byte>> solver;  ///< as Solver::state()

    /// From the host's copy. Memory that it has already is used again.
    void take(const Model& model, Solver& solver);
    /// Into the host's copy.
    void put(Model& model, Solver& solver) const;

    /// xyz of all vertices in scene order, counted from the model's origin [m], [m/s].
    std::vector<float> ordered_positions(const Model& model) const;
    std::vector<float> ordered_velocities(const Model& model) const;
    /// Of the state, all its digits. May run while the model goes on.
    std::string hash(const Model& model) const;

    Checkpoint checkpoint(int frame) const;
    /// Throws UserError if the checkpoint's state has another size.
    void take(const Checkpoint& checkpoint);
};

}  // namespace weft
