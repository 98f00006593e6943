#pragma once

#include "simulation/mesh/triangle_mesh.h"

namespace weft {

/// "weft: warning: ..." on stderr, each.
void print_warnings(const Warnings& warnings);

}  // namespace weft
