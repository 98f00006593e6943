#pragma once

#include <array>
#include <span>

#include "simulation/model/gathered.h"

namespace weft {

/// What thickness contacts of such a surface had best have [m], or 0 without triangles.
/// triangles: of `rest`, by its indices; rest: positions [m]
double good_thickness(std::span<const std::array<int, 3>> triangles, std::span<const Vec3> rest);

/// Chooses the thickness of contacts where the scene does not say it: a quarter of the mean edge
/// of all surfaces, and less than the shortest one, so that neighbours in one surface do not count
/// as near; and less than what bodies are apart at the start, so that they do not push each other
/// off; a tenth of the mean edge at least. Warns of one that is more than half of the mean edge, or
/// more than they are apart. warnings: null: nobody listens
void choose_thickness(Contact& contact, const Gathered& all, Warnings* warnings);

/// The least distance that contact leaves between two surfaces [m]: a tenth of the thickness, but
/// enough for the rounding of coordinates up to `reach` [m].
double contact_floor(double thickness, double reach);

}  // namespace weft
