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
    double gravity = 0.0;           ///< potential, zero at the scene's origin
    std::vector<double> elements;   ///< of the model's families
    std::optional<double> contact;  ///< none: the scene has no [contact]

    double strain() const;              ///< of all elements, and what is stored in contacts
    std::vector<double> parts() const;  ///< what strain() is the sum of, as energy_names() has it
    double total() const { return kinetic + gravity + strain(); }
};

/// Names of the energies that the model has besides kinetic and gravity.
std::vector<std::string> energy_names(const Model& model);
/// Of a state at a time [s]: x y z and inverse mass, and velocities, in the new order. May run
/// while the model goes on. contact: what contacts have stored there [J], which a state by itself
/// does not tell
Energies measure_energies(const Model& model, std::span<const float4> positions,
                          std::span<const float4> velocities, double time, double contact = 0.0);

/// The first vertex whose position or velocity is not finite.
std::optional<BadState> find_non_finite(const Model& model);
/// The first vertex of a finite state that is too fast, or is at an overstretched edge; by the
/// bounds of the scene's [guard]. strain: the model's
std::optional<BadState> find_beyond_guard(const Model& model, const Strain& strain);

/// Sum of mass times place of all that moves freely, in the scene's own coordinates [kg m].
Vec3 mass_moment(const Model& model, std::span<const float4> positions);

/// "vertex 12 of cloth 'sheet'"
std::string vertex_name(const Model& model, int vertex);

}  // namespace weft
