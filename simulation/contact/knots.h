#pragma once

#include <vector>

#include "simulation/model/model.h"

namespace weft {

/// Of each vertex (new order) a number that those have in common that are tied together in one
/// place: by a stitch, or by an attachment no longer at time 0 than `thickness` [m]. Contact takes
/// them for one vertex: surfaces that are sewn or tied together are neighbours there, as two
/// triangles of one mesh are. What no tie holds has a number of its own.
std::vector<int> knots_of(const Model& model, double thickness);

}  // namespace weft
