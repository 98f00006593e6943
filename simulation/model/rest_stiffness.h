#pragma once

#include <array>
#include <span>

#include "simulation/families/family.h"

namespace weft {

/// How hard an element holds each of its corners where they are: a third of the trace of the
/// corner's own block of its Hessian, where that is not negative [N/m].
/// positions  [vertices]
std::array<double, kMaxCorners> rest_stiffness(const ElementFamily& family, int element,
                                               std::span<const float4> positions);

}  // namespace weft
