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

/// What is to be said of a state between two frames.
struct StateLook {
    std::optional<BadState> non_finite;  ///< as above; there is no meaning in the rest then
    /// The first vertex that is too fast, or is at an overstretched edge; by the bounds of the
    /// scene's [guard].
    std::optional<BadState> beyond_guard;
    Strain strain;
    Energies energies;
};
/// Of the model's, at a time [s], with all that is looked at in one go: threads are woken once.
/// contact: as above. with_energies: or else there are none
StateLook look_at_state(const Model& model, double time, double contact, bool with_energies);

/// Sum of mass times place of all that moves freely, in the scene's own coordinates [kg m].
Vec3 mass_moment(const Model& model, std::span<const float4> positions);

/// "cloth 'sheet'", which a vertex belongs to
std::string body_name(const Model& model, int vertex);
/// "vertex 12 of cloth 'sheet'"
std::string vertex_name(const Model& model, int vertex);

}  // namespace weft
