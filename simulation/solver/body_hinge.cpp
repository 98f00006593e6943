#include "simulation/solver/body_hinge.h"

#include <algorithm>
#include <limits>

#include "simulation/families/convert.h"

namespace weft {

namespace {

/// What of the line's length held vertices may be beside it.
constexpr double kBeside = 1e-5;
/// And of where they are: rounding.
constexpr double kRounding = 4.0 * static_cast<double>(std::numeric_limits<float>::epsilon());

Vec3 place(const Model& model, int vertex) {
    return to_vec3((*model.positions)[static_cast<std::size_t>(vertex)]);
}

/// Two on a line are so wherever they go; others stay on it if they are led by one motion.
bool stay_on_a_line(const Model& model, std::span<const int> held) {
    if (held.size() <= 2 || !model.moving_pins) return true;
    const MovingPins& pins = *model.moving_pins;
    const auto group = pins.group_of(held.front());
    const auto is_in_it = [&](int v) { return pins.group_of(v) == group; };
    return std::ranges::all_of(held, is_in_it) && (!group || pins.is_rigid(*group));
}

int farthest_from(const Model& model, std::span<const int> held, int vertex) {
    const auto distance = [&](int v) { return length(place(model, v) - place(model, vertex)); };
    return *std::ranges::max_element(held, {}, distance);
}

}  // namespace

BodyHinge hinge_of(const Model& model, std::span<const int> held) {
    const int from = farthest_from(model, held, held.front());
    const int to = farthest_from(model, held, from);
    const Vec3 line = place(model, to) - place(model, from);
    const double size = length(line);
    const double rounding =
        kRounding * std::max(length(place(model, from)), length(place(model, to)));
    if (!stay_on_a_line(model, held)) return {from, to, false};
    if (size <= rounding) return {from, from, true};
    const auto is_beside = [&](int v) {
        const double aside = length(cross(line, place(model, v) - place(model, from))) / size;
        return aside > kBeside * size + rounding;
    };
    if (std::ranges::any_of(held, is_beside)) return {from, to, false};
    return {from, to, true};
}

}  // namespace weft
