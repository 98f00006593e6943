#pragma once

#include <span>

#include "runtime/buffer.h"

namespace weft {

/// The largest coordinate, as single precision rounds by it [m].
double reach_of(std::span<const float4> positions);

}  // namespace weft
