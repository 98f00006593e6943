#pragma once

#include <array>
#include <span>
#include <vector>

#include "simulation/mesh/vec3.h"

namespace weft {

/// Splits a polygon into triangles by cutting off one corner after the other, as seen along its
/// normal by Newell's sum; it need not be convex, nor quite flat. A quad is cut along its shorter
/// diagonal, if both leave it whole.
/// corners  in order [m]
/// Returns triples of indices into `corners`, turning as the polygon does; empty where it crosses
/// itself, or has no area.
std::vector<std::array<int, 3>> split_polygon(std::span<const Vec3> corners);

}  // namespace weft
