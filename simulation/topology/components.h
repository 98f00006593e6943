#pragma once

#include <span>
#include <vector>

#include "simulation/topology/stencils.h"

namespace weft {

/// Where the connected components of vertices begin, and vertex_count: component c is [begin[c],
/// begin[c + 1]). For an order in which each is contiguous, as that of Strips.
std::vector<int> component_begins(int vertex_count, std::span<const Stencils> kinds);

}  // namespace weft
