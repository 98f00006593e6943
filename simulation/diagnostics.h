#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "simulation/model/model.h"

namespace weft {

/// The energies of a state [J], in double precision.
struct Energies {
    double kinetic = 0.0;
    double gravity = 0.0;          ///< potential, zero at the origin
    std::vector<double> elements;  ///< in the order of energy_names()
};

/// Names of the element energies that the model has.
std::vector<std::string> energy_names(const Model& model);
/// Of a state at a time [s]: x y z and inverse mass, and velocities, in the new order. May run
/// while the model goes on.
Energies measure_energies(const Model& model, std::span<const float4> positions,
                          std::span<const float4> velocities, double time);

/// The first vertex that is not finite, too fast, or at an overstretched element; by the
/// bounds of the scene's [guard].
std::optional<BadState> find_bad_state(const Model& model);
/// Only whether positions are finite: what can be said in mid-substep.
std::optional<BadState> find_non_finite(const Model& model);

/// "vertex 12 of cloth 'sheet'"
std::string vertex_name(const Model& model, int vertex);

}  // namespace weft
