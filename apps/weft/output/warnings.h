#pragma once

#include "simulation/mesh/triangle_mesh.h"

namespace weft {

/// "weft: warning: ..." on stderr, each.
void print_warnings(const Warnings& warnings);

/// Likewise, if the user's cache folder cannot be used.
void warn_of_cache_folder();

}  // namespace weft
