#pragma once

#include <span>

#include "runtime/buffer.h"

namespace weft {

/// The largest coordinate, as single precision rounds by it [m].
double reach_of(std::span<const float4> positions);

/// What single precision takes from a coordinate of that size, or gives to it [m].
double rounding_at(double reach);

/// Steps are too short where that is so many times the way that gravity makes in one (see
/// simulation/checks/start_checks.cpp).
inline constexpr double kTooShortBy = 2.0;

}  // namespace weft
