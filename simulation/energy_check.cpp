#include "simulation/energy_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "simulation/families/convert.h"

namespace weft {

namespace {

// Beyond what sweeps of few iterations do in scenes that look as they should: their strain is a
// few times what it would be, their motion is not.
constexpr double kMostMotion = 2.0;
constexpr double kMostStrain = 10.0;
constexpr double kSmallFall = 0.01;  ///< of the size of everything

bool has_moving_pins(const auto& bodies) {
    return std::ranges::any_of(bodies, [](const auto& body) {
        return std::ranges::any_of(body.pins, [](const auto& pins) { return !!pins.motion; });
    });
}

bool does_no_work(const Scene& scene) {
    const auto moves = [](const Obstacle& obstacle) { return obstacle.motion.has_value(); };
    return scene.gravity_keys.empty() && scene.seams.empty() && !has_moving_pins(scene.cloths) &&
           !has_moving_pins(scene.solids) && std::ranges::none_of(scene.obstacles, moves);
}

double strain_of(const FrameRecord& state) {
    return std::accumulate(state.energies.begin(), state.energies.end(), 0.0);
}

/// The diagonal of the box around all vertices [m].
double size_of(const Model& model) {
    Vec3 low, high;
    for (std::size_t v = 0; v < model.positions->count(); ++v) {
        const Vec3 x = to_vec3((*model.positions)[v]);
        if (v == 0) low = high = x;
        low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
        high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
    }
    return length(high - low);
}

}  // namespace

EnergyCheck::EnergyCheck(const Model& model, const FrameRecord& start)
    : is_closed_(does_no_work(model.scene)),
      start_(start.kinetic_energy + start.gravity_energy + strain_of(start)),
      small_(kSmallFall * size_of(model) * length(model.scene.gravity) *
             std::accumulate(model.masses.begin(), model.masses.end(), 0.0)) {}

std::optional<std::string> EnergyCheck::look(const FrameRecord& end) const {
    const double to_be_had = std::max(start_ - end.gravity_energy, 0.0);
    const double motion = end.kinetic_energy;
    const double strain = strain_of(end);
    const bool is_fine =
        motion <= kMostMotion * to_be_had + small_ && strain <= kMostStrain * (to_be_had + small_);
    if (!is_closed_ || is_fine) return std::nullopt;
    return fmt::format(
        "energy from nowhere: {:.3g} J of motion and {:.3g} J of strain at the end, where {:.3g} J "
        "were to be had: the steps are not solved far enough, and what is seen is not believable; "
        "more substeps or iterations, or another solver, may help (docs/solvers.md)",
        motion, strain, to_be_had);
}

}  // namespace weft
