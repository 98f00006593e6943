#pragma once

#include <vector>

#include "simulation/model/gathered.h"

namespace weft {

/// How far triangles are from other bodies at the start [m], ascending: of those that may move, or
/// of some 2,000 of them. Who is no nearer than `within` has that. Bodies that are tied to each
/// other do not count.
std::vector<double> distances_to_others(const Gathered& all, double within);

}  // namespace weft
