#pragma once

#include "simulation/state/simulation_state.h"

namespace weft {

/// What was done to a model's bodies in a frame by all that moves by itself, as far as the states
/// at both of the frame's ends tell.
struct OutsideWork {
    double work = 0.0;   ///< [J]
    double doubt = 0.0;  ///< [J] by which it may be larger, for what happened in between
};

/// By gravity that changes, by pins that move, and by obstacles that move and touch something at
/// the frame's end. Forces are those that hold against the elements (and gravity) at both ends.
/// model: at `end` [s]; before: at `start`
OutsideWork outside_work(const Model& model, const SimulationState& before, double start,
                         double end);

}  // namespace weft
