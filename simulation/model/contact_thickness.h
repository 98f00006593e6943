#pragma once

#include "simulation/model/gathered.h"

namespace weft {

/// Chooses the thickness of contacts where the scene does not say it: a quarter of the mean edge
/// of all surfaces, and less than the shortest one, so that neighbours in one surface do not count
/// as near. Warns of one that is more than half of the mean edge.
void choose_thickness(Contact& contact, const Gathered& all, Warnings& warnings);

/// The least distance that contact leaves between two surfaces [m]: a tenth of the thickness, but
/// enough for the rounding of coordinates up to `reach` [m].
double contact_floor(double thickness, double reach);

}  // namespace weft
